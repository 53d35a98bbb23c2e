// EXT_meshopt_compression: bufferViews that meshoptimizer has packed.
#pragma once

#include "scene/import/gltf_document.h"

namespace nephroid::gltf {

/// Decodes every compressed bufferView into `document.decompressed`.
/// @throws InputError on sizes that do not fit together, unknown modes and filters, and damaged data
/// @see EXT_meshopt_compression, sections "JSON schema updates" and appendices A and B (formats of modes and filters)
void decompressViews(Document& document);

}  // namespace nephroid::gltf

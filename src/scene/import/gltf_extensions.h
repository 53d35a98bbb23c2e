// Which extensions are understood, and what is said about the others.
#pragma once

#include "scene/import/gltf_document.h"

namespace nephroid::gltf {

/// Refuses required extensions that are not supported, warns about others.
/// @throws InputError naming the extension
void checkExtensions(Document& document);

}  // namespace nephroid::gltf

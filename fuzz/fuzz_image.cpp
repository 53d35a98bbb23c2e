// The image decoders on arbitrary bytes: PNG, JPEG, WebP, EXR and HDR are told apart by content.
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/image/image_io.h"
#include "nephroid/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    nephroid::decodeImage({reinterpret_cast<const std::byte*>(data), size}, "fuzz input");
  } catch (const nephroid::Error&) {
    return 0;
  }
  return 0;
}

// How layers and metadata are named inside an EXR file: said once for the writer and the reader.
#pragma once

#include <string>
#include <string_view>

namespace nephroid {

/// The layer that is stored without a prefix, so that every viewer shows it.
inline constexpr std::string_view kBaseLayer = "beauty";

/// Put before our metadata keys: some plain names ("version", "type", "name") have a meaning and a type of their own
/// in EXR, and a file that breaks it cannot be opened by newer libraries.
inline constexpr std::string_view kMetadataPrefix = "nephroid.";

/// "R" of layer "beauty" is channel "R", of layer "caustic" channel "caustic.R".
inline std::string makeChannelName(std::string_view layer, std::string_view component) {
  return layer == kBaseLayer ? std::string(component) : std::string(layer) + "." + std::string(component);
}

/// The component of a one-channel layer: Z is what compositing programs look for as depth.
inline std::string_view getScalarComponent(std::string_view layer) {
  if (layer == "depth") return "Z";
  return layer == "id" ? "I" : "Y";
}

}  // namespace nephroid

// The layers (AOVs) that every technique speaks of, declared once.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nephroid {

struct LayerInfo {
  std::string_view name;
  int channels;
  bool summed;  ///< part of the partition whose sum is `beauty`
  std::string_view unit;
  std::string_view text;
};

/// All layers in the order in which files store them.
std::span<const LayerInfo> layerInfos();

/// @throws UsageError with the names there are
const LayerInfo& findLayerInfo(std::string_view name);

/// "caustic" for "caustic_error": whose standard error a layer shows; "" for all other layers.
std::string_view erringLayer(std::string_view name);

/// Whether a layer is about the error of others: a standard error or a bias.
bool isEstimate(std::string_view name);

/// "beauty,caustic" → names, checked, in file order, without repetition.
/// @throws UsageError
std::vector<std::string> parseLayerList(std::string_view comma_separated);

}  // namespace nephroid

// EXR as a stack of layers, bit by bit as stored (also NaN: whoever measures should see it).
// Only the first part is read: that is where writeExr and other renderers put their layers.

#include <ImfChannelList.h>
#include <ImfStringAttribute.h>

#include <map>
#include <utility>
#include <vector>

#include "core/file.h"
#include "core/image/exr_file.h"
#include "core/image/exr_layers.h"
#include "core/image/image_io.h"

namespace nephroid {
namespace {

/// What becomes one layer: its name and its channels in order.
struct LayerChannels {
  std::string name;
  std::vector<std::string> channels;
};

bool hasAll(const std::vector<std::string>& components, std::initializer_list<const char*> wanted) {
  return std::ranges::all_of(wanted,
                             [&](const char* name) { return std::ranges::find(components, name) != components.end(); });
}

/// The layers of the channels that share a prefix: R,G,B or X,Y,Z make one of three channels, a lone component one of
/// one; what is left over (alpha, say) becomes one-channel layers with its full name.
std::vector<LayerChannels> splitGroup(const std::string& prefix, std::vector<std::string> components) {
  const std::string layer = prefix.empty() ? std::string(kBaseLayer) : prefix;
  const auto qualify = [&](const std::string& component) {
    return prefix.empty() ? component : prefix + "." + component;
  };
  std::vector<LayerChannels> layers;
  for (const auto& triple : {std::vector<std::string>{"R", "G", "B"}, std::vector<std::string>{"X", "Y", "Z"}}) {
    if (!hasAll(components, {triple[0].c_str(), triple[1].c_str(), triple[2].c_str()})) continue;
    layers.push_back({layer, {qualify(triple[0]), qualify(triple[1]), qualify(triple[2])}});
    std::erase_if(components, [&](const std::string& c) { return std::ranges::find(triple, c) != triple.end(); });
    break;
  }
  const bool is_scalar_layer = layers.empty() && components.size() == 1 && (!prefix.empty() || components[0] == "Y");
  for (const std::string& component : components)
    layers.push_back({is_scalar_layer ? layer : qualify(component), {qualify(component)}});
  return layers;
}

std::vector<LayerChannels> groupChannels(const Imf::Header& header) {
  std::map<std::string, std::vector<std::string>> groups;  // the prefix "" comes first: beauty leads
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    const std::string name = it.name();
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos)
      groups[""].push_back(name);
    else
      groups[name.substr(0, dot)].push_back(name.substr(dot + 1));
  }
  std::vector<LayerChannels> layers;
  for (const auto& [prefix, components] : groups)
    for (LayerChannels& layer : splitGroup(prefix, components)) layers.push_back(std::move(layer));
  return layers;
}

std::map<std::string, std::string> readMetadata(const Imf::Header& header) {
  std::map<std::string, std::string> metadata;
  for (auto it = header.begin(); it != header.end(); ++it) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
    if (text == nullptr) continue;
    const std::string name = it.name();
    if (name.starts_with(kMetadataPrefix))
      metadata.insert_or_assign(name.substr(kMetadataPrefix.size()), text->value());
    else
      metadata.try_emplace(name, text->value());
  }
  return metadata;
}

std::vector<Layer> readLayers(const ExrFile& file) {
  const Imf::Header& header = file.header(0);
  std::vector<Layer> layers;
  if (hasChannels(header, {"Y", "RY", "BY"})) {
    layers.push_back({std::string(kBaseLayer), file.readLuminanceChroma()});
    return layers;
  }
  std::vector<std::vector<std::string>> channel_lists;
  for (LayerChannels& layer : groupChannels(header)) {
    layers.push_back({std::move(layer.name), Image()});
    channel_lists.push_back(std::move(layer.channels));
  }
  // All at once: the blocks of the file hold all channels and would be unpacked for each layer.
  std::vector<Image> images = file.readImages(0, channel_lists);
  for (std::size_t i = 0; i < layers.size(); ++i) layers[i].image = std::move(images[i]);
  return layers;
}

}  // namespace

LayeredImage readExr(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = readFile(path);
  const std::string label = path.string();
  return guardExr(label, [&] {
    const ExrFile file(bytes, label);
    file.checkPart(0);
    LayeredImage image;
    image.layers = readLayers(file);
    if (image.layers.empty()) throw InputError(label + ": OpenEXR image without channels; expected R, G, B or layers");
    image.width = image.layers.front().image.width;
    image.height = image.layers.front().image.height;
    image.metadata = readMetadata(file.header(0));
    return image;
  });
}

}  // namespace nephroid

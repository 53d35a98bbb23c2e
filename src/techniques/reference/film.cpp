#include "techniques/reference/film.h"

#include <algorithm>

#include "techniques/layers.h"

namespace nephroid {

LayerNeeds::LayerNeeds(const std::vector<std::string>& layers) {
  const auto has = [&](std::string_view name) {
    return std::any_of(layers.begin(), layers.end(),
                       [&](const std::string& layer) { return layer == name || erringLayer(layer) == name; });
  };
  beauty = has("beauty");
  emission = beauty || has("emission");
  direct = beauty || has("direct");
  caustic_bias = has("caustic_bias");
  caustic = beauty || has("caustic") || caustic_bias;
  specular = beauty || has("specular");
  indirect = beauty || has("indirect");
  specular_caustic = has("specular_caustic");
  specular_caustic_bias = has("specular_caustic_bias");
  irradiance = has("irradiance");
  irradiance_caustic = has("irradiance_caustic");
  geometry = has("albedo") || has("normal") || has("position") || has("depth") || has("id");
}

Film::Film(int w, int h, const LayerNeeds& needs) : width(w), height(h) {
  const auto activate = [&](FilmPlane& plane, bool wanted) {
    if (wanted) plane = FilmPlane(w, h);
  };
  activate(emission, needs.emission);
  activate(direct, needs.direct);
  activate(caustic_from_eye, needs.caustic);
  activate(caustic, needs.caustic);
  activate(specular, needs.specular);
  activate(indirect_from_eye, needs.indirect);
  activate(indirect, needs.indirect);
  activate(specular_caustic, needs.specular_caustic);
  activate(caustic_bias, needs.caustic_bias);
  activate(specular_caustic_bias, needs.specular_caustic_bias);
  activate(irradiance_from_eye, needs.irradiance);
  activate(irradiance, needs.irradiance);
  activate(irradiance_caustic_from_eye, needs.irradiance_caustic);
  activate(irradiance_caustic, needs.irradiance_caustic);
}

std::vector<LayerPlanes> planesOf(const Film& film, std::string_view layer) {
  struct Entry {
    std::string_view layer;
    LayerPlanes planes;
  };
  const Entry entries[] = {{"direct", {&film.direct, nullptr}},
                           {"caustic", {&film.caustic_from_eye, &film.caustic}},
                           {"specular", {&film.specular, nullptr}},
                           {"indirect", {&film.indirect_from_eye, &film.indirect}},
                           {"emission", {&film.emission, nullptr}},
                           {"specular_caustic", {&film.specular_caustic, nullptr}},
                           {"caustic_bias", {&film.caustic_bias, nullptr}},
                           {"specular_caustic_bias", {&film.specular_caustic_bias, nullptr}},
                           {"irradiance", {&film.irradiance_from_eye, &film.irradiance}},
                           {"irradiance_caustic", {&film.irradiance_caustic_from_eye, &film.irradiance_caustic}}};
  std::vector<LayerPlanes> planes;
  for (const Entry& entry : entries)
    if (entry.layer == layer || (layer == "beauty" && findLayerInfo(entry.layer).summed))
      planes.push_back(entry.planes);
  return planes;
}

Image developLayer(const Film& film, std::string_view layer, const FilmCounts& counts) {
  const std::vector<LayerPlanes> parts = planesOf(film, layer);
  Image image(film.width, film.height, 3);
  const double by_batches = counts.batches > 0 ? 1.0 / static_cast<double>(counts.batches) : 0.0;
  const PictureTiles& tiles = counts.passes.tiles();
  for (std::size_t tile = 0; tile < tiles.count(); ++tile) {
    const std::uint64_t passes = counts.passes.done()[tile];
    const double by_passes = passes > 0 ? 1.0 / static_cast<double>(passes) : 0.0;
    tiles.visitPixels(tile, [&](int x, int y) {
      const std::size_t pixel = tiles.pixelOf(x, y);
      vec3 sum(0.0F);
      for (const LayerPlanes& part : parts) {
        // Each layer is rounded to float before the sum, so that the files' layers add up to the files' beauty.
        dvec3 value(0.0);
        if (part.from_eye && part.from_eye->active()) value += part.from_eye->at(pixel) * by_passes;
        if (part.from_lights && part.from_lights->active()) value += part.from_lights->at(pixel) * by_batches;
        sum += vec3(value);
      }
      image.setRgb(x, y, sum);
    });
  }
  return image;
}

}  // namespace nephroid

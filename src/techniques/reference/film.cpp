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
  caustic = beauty || has("caustic");
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
  for (std::size_t pixel = 0; pixel < image.pixels.size() / 3; ++pixel) {
    const std::size_t row = pixel / static_cast<std::size_t>(film.width);
    const std::uint64_t samples = counts.samples + counts.rows_ahead[row];
    const double by_samples = samples > 0 ? 1.0 / static_cast<double>(samples) : 0.0;
    vec3 sum(0.0F);
    for (const LayerPlanes& part : parts) {
      // Each layer is rounded to float before the sum, so that the files' layers add up to the files' beauty.
      dvec3 value(0.0);
      if (part.from_eye && part.from_eye->active()) value += part.from_eye->at(pixel) * by_samples;
      if (part.from_lights && part.from_lights->active()) value += part.from_lights->at(pixel) * by_batches;
      sum += vec3(value);
    }
    image.setRgb(static_cast<int>(pixel % static_cast<std::size_t>(film.width)), static_cast<int>(row), sum);
  }
  return image;
}

}  // namespace nephroid

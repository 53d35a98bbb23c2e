#include "techniques/reference/film.h"

#include <algorithm>

namespace nephroid {

LayerNeeds::LayerNeeds(const std::vector<std::string>& layers) {
  const auto has = [&](std::string_view name) { return std::find(layers.begin(), layers.end(), name) != layers.end(); };
  beauty = has("beauty");
  emission = beauty || has("emission");
  direct = beauty || has("direct");
  caustic = beauty || has("caustic");
  specular = beauty || has("specular");
  indirect = beauty || has("indirect");
  specular_caustic = has("specular_caustic");
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
  activate(irradiance_from_eye, needs.irradiance);
  activate(irradiance, needs.irradiance);
  activate(irradiance_caustic_from_eye, needs.irradiance_caustic);
  activate(irradiance_caustic, needs.irradiance_caustic);
}

}  // namespace nephroid

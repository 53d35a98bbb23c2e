// What the command line changes in a scene after loading: the --material, --object, --light, --camera, --env options.
#pragma once

#include <string_view>

#include "scene/scene_data.h"

namespace nephroid {

/// 'GLOB:key=value,…' with keys ior, transmission, thickness, roughness, metallic, baseColor, abbe, dispersion,
/// attenuation (colour), attenuationDistance, emission, specular, priority, eta, k. GLOB ('*', '?') matches material
/// names, or the name of the node that uses the material (which then gets a copy of its own).
/// @throws UsageError, also when nothing matches (the message lists the names)
void applyMaterialEdit(SceneData& scene, std::string_view edit);

/// 'NAME:translate=x,y,z,rotate=x,y,z,scale=s,cast=true|false': degrees about X, then Y, then Z; about the object's own
/// origin. NAME may be a GLOB.
/// @throws UsageError
void applyObjectEdit(SceneData& scene, std::string_view edit);

/// 'NAME:key=value,…' changes a light; 'sun:azimuth=…,elevation=…,irradiance=…', 'point:…' or 'spot:…', where no light
/// of that name exists, adds one. Keys: position, direction, azimuth, elevation (deg, of where the light comes from;
/// azimuth 0 is +Z, 90 is +X), intensity, irradiance, color, radius, angle, inner, outer (deg), off.
/// @throws UsageError
void applyLightEdit(SceneData& scene, std::string_view edit);

/// A camera by NAME, INDEX or 'eye=x,y,z:target=x,y,z:fov=DEG[:ortho=H][:up=x,y,z]'.
/// @throws UsageError (lists the cameras there are)
Camera selectCamera(const SceneData& scene, std::string_view choice);

/// An EXR or HDR file (lat-long), or 'sky[:turbidity=…,elevation=…,azimuth=…,irradiance=…]', the analytic sky.
/// @throws InputError, UsageError
Environment loadEnvironment(std::string_view source, float rotation_deg, float scale);

}  // namespace nephroid

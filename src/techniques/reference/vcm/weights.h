// The weights by which vertex connection and merging combines every way to make one path.
//
// Balance heuristic over all techniques, in the recursive form of [georgiev-2012-vcm] (Eqs. 34 to 41 of its technical
// report [georgiev-2012-tr]): each half of a path carries two numbers,
//
//   dvcm_i = 1 / p_i                                                                                     (Eqs. 31, 34)
//   dvc_i  = g_{i−1} / p_i · (η·[vertex i−1 merges] + dvcm_{i−1} + p_rev,{i−2} · dvc_{i−1})              (Eqs. 32, 35)
//
// with p_i the density per area of making vertex i from vertex i−1 along this half, p_rev,{i−2} the density per solid
// angle of going on from i−1 to i−2 along the other half, g_{i−1} = |cos|/d² from there, and η = π r² N the number of
// photons that a kernel finds per unit of their density. The report's third, dvm, is dvc/η throughout, and is left out.
//
// What differs: only paths of one class are made here, L S⁺ D S* E, and not by every technique that could. Photons end
// at their first D, so nothing connects beyond it to the eye but that vertex itself; and D alone merges. A weight may
// leave out any technique that nobody uses: `forgetLightEnd` and η = 0 at the other vertices say which.
// Probabilities of discrete choices at delta vertices are the same in both directions and cancel. All densities are
// functions of the path alone, so whatever they are, the weights of the techniques used sum to one.
#pragma once

#include <cmath>

namespace nephroid {

/// What one half of a path has gathered up to its last vertex.
struct VcmPartial {
  float dvcm = 0.0F;  ///< towards connecting this vertex; m² or sr, as the density that it inverts
  float dvc = 0.0F;   ///< towards all that takes vertices of this half into the other

  /// First vertex of a photon. @param direct   density with which the vertex would find the light (LightSet)
  /// @param arrival   density of photons there (Emitter::arrivalDensity), times the emitter's share of photons
  /// @param cos_in    |cosine| at the vertex, on the true surface, as everywhere here
  /// @param has_size  the light can be met by paths from the eye
  static VcmPartial startAtLight(float direct, float arrival, float cos_in, bool has_size) {
    const float inverse = 1.0F / (arrival * cos_in);
    return {direct * inverse, has_size ? inverse : 0.0F};
  }
  /// First vertex of a path from the eye. @param photons  N, of which each is connected to the camera
  /// @param importance  paths from the eye per area perpendicular to the ray, 1/m²
  static VcmPartial startAtEye(float photons, float importance, float cos_in) {
    return {photons / (importance * cos_in), 0.0F};
  }

  /// At the next vertex: densities per solid angle become densities per area.
  VcmPartial arrive(float distance_squared, float cos_in) const {
    return {dvcm * distance_squared / cos_in, dvc / cos_in};
  }
  /// Leaves a vertex that can be connected. @param pdf, pdf_reverse  per solid angle, of the way on, and of the way
  /// back
  /// @param merging  η if the vertex merges, else 0
  VcmPartial scatter(float cos_out, float pdf, float pdf_reverse, float merging) const {
    return {1.0F / pdf, cos_out / pdf * (merging + dvcm + pdf_reverse * dvc)};
  }
  /// Leaves a mirror or clear glass: it can neither be connected nor merge.
  VcmPartial scatterDelta(float cos_out) const { return {0.0F, cos_out * dvc}; }
  /// No photon is followed beyond this vertex, so none of the techniques on the eye's side of it are used.
  VcmPartial forgetLightEnd() const { return {dvcm, 0.0F}; }

  /// Sum over the techniques that move the end vertex, or more of this half, into the other, over the one that connects
  /// or meets it. @param pdf_reverse  from this vertex back along this half, per solid angle
  float sumBehind(float pdf_reverse, float merging) const { return merging + dvcm + pdf_reverse * dvc; }
};

/// A path from the eye meets a light. @param half     at its last event, after it
/// @param direct   density with which the last vertex would find the light
/// @param arrival  of photons at the last vertex, times the emitter's share
inline float weighMet(const VcmPartial& half, float direct, float arrival) {
  return 1.0F / (1.0F + direct * half.dvcm + arrival * half.dvc);
}
/// A vertex of a path from the eye finds a light. @param pdf  of meeting it by chance, per solid angle; 0 if it cannot
/// be
/// @param behind  of the vertex: sumBehind
inline float weighFound(float direct, float pdf, float arrival, float cos_vertex, float behind) {
  return 1.0F / (1.0F + (pdf + arrival * cos_vertex * behind) / direct);
}
/// A photon is seen by the camera. @param importance  as in startAtEye  @param behind  of the photon
inline float weighSeen(float photons, float importance, float cos_camera, float behind) {
  return 1.0F / (1.0F + importance * cos_camera / photons * behind);
}
/// A vertex of each half is connected. @param eye_pdf, light_pdf  of the other vertex, by each half, per area
inline float weighConnection(float eye_pdf, float light_behind, float light_pdf, float eye_behind) {
  return 1.0F / (1.0F + eye_pdf * light_behind + light_pdf * eye_behind);
}
/// A photon is found within the kernel of a vertex from the eye. @param pdf_reverse  from the vertex to where the
/// photon came from
inline float weighMerge(const VcmPartial& photon, const VcmPartial& eye, float pdf_reverse, float merging) {
  return merging / (merging + photon.dvcm + photon.dvc * pdf_reverse + eye.dvcm);
}

}  // namespace nephroid

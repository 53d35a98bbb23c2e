#include "techniques/reference/footprint_pilot.h"

#include <array>
#include <cmath>

#include "core/sampling/warp.h"

namespace nephroid {
namespace {

/// Photons per overlap that is tried: the share that strays is known to about two per cent.
constexpr std::uint32_t kPilotPhotons = 1024;
/// Overlaps that are tried. From 0.1 on, errors of smooth scenes hardly change; at the least, kernels are narrower than
/// the spacing of photons, and still halve the noise of a finely modelled one.
constexpr std::array kOverlaps{0.1F, 0.025F, 0.006F, 0.0015F};
/// Share of neighbours that may end elsewhere: smooth scenes have 1 to 6 %, those at edges; a glass bunny of 59 000
/// triangles has 25 % and more.
constexpr double kMostStraying = 0.08;
/// A place and a direction within unit discs, projected to the receiver: no straight footprint reaches farther, in
/// squared half-axes.
constexpr float kFarthest = 2.0F;
/// Random numbers of their own: streams of pixels and lights lie elsewhere.
constexpr std::uint32_t kPhotonStream = 0xF0070000U, kNeighbourStream = 0xF0070001U;

/// Another photon from the cell of the first one, whose random choices it repeats.
PhotonWave::Photon makeNeighbour(const PhotonWave::Photon& photon, const EmissionExtent& extent,
                                 const FootprintSplat& footprint, Sampler sampler) {
  PhotonWave::Photon neighbour = photon;
  const float per_extent = 1.0F / std::sqrt(kPi);  // radius of a disc over the side of the square of its area
  const vec2 place = extent.place * footprint.place_share * per_extent * sampleConcentricDisc(sampler.next2D());
  const vec2 turn = extent.direction * footprint.direction_share * per_extent * sampleConcentricDisc(sampler.next2D());
  const Frame frame = Frame::fromZ(photon.emitted.dir);
  neighbour.emitted.origin += place.x * frame.x + place.y * frame.y;
  neighbour.emitted.dir = normalize(photon.emitted.dir + turn.x * frame.x + turn.y * frame.y);
  return neighbour;
}

/// Share of neighbours that do not end within their footprint, of photons that end where they are seen.
double measureStraying(const LightTracer& tracer, std::size_t emitter, const FootprintScale& scale,
                       std::uint32_t seed) {
  int pairs = 0, straying = 0;
  for (std::uint32_t i = 0; i < kPilotPhotons; ++i) {
    PhotonWave::Photon photon{{}, Sampler(seed, kPhotonStream, i)};
    photon.emitted = tracer.emitters()[emitter]->emit(photon.sampler);
    const auto landing = tracer.findLanding(emitter, photon, scale);
    if (!landing) continue;
    ++pairs;
    const EmissionExtent extent = tracer.emitters()[emitter]->extentOf(photon.emitted);
    const auto other =
        tracer.findLanding(emitter, makeNeighbour(photon, extent, *landing, Sampler(seed, kNeighbourStream, i)), scale);
    if (!other || squaredRadiusAt(*landing, other->film) > kFarthest) ++straying;
  }
  return pairs > 0 ? static_cast<double>(straying) / pairs : 0.0;
}

}  // namespace

std::vector<float> chooseFootprintOverlaps(const LightTracer& tracer, const std::vector<std::uint32_t>& photons,
                                           std::uint32_t seed) {
  std::vector<float> overlaps;
  for (std::size_t e = 0; e < photons.size(); ++e) {
    float chosen = kOverlaps.back();
    for (const float overlap : kOverlaps) {
      if (overlap == kOverlaps.back()) break;
      if (measureStraying(tracer, e, tracer.scaleFootprints(overlap, photons[e], 0), seed) > kMostStraying) continue;
      chosen = overlap;
      break;
    }
    overlaps.push_back(chosen);
  }
  return overlaps;
}

}  // namespace nephroid

#include "frame/deposit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>

#include "core/sampling/sampler.h"
#include "frame/low_pass.h"
#include "frame/surface_layers.h"
#include "frame/view.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

constexpr std::uint32_t kGrid = 24, kSize = 64;
/// Side of a texel of the picture from above, m.
constexpr double kTexel = 4.0 * 1.001 / kSize;

/// What became of photons on a floor of 4 m.
struct Deposited {
  std::vector<dvec3> flux;       ///< W, by view and texel
  std::vector<dvec3> direction;  ///< luminance times direction
  dvec3 lost{0.0};
  std::vector<std::int32_t> steps;  ///< as they are in the map

  dvec3 total() const {
    dvec3 sum(0.0);
    for (const dvec3& f : flux) sum += f;
    return sum;
  }
};

struct DepositOptions {
  Reconstruction reconstruction = Reconstruction::kQuads;
  float low_pass = 0.0F;     ///< texels
  bool has_a_plate = false;  ///< 0.5 m over the floor where x > 0
  bool has_slats = false;    ///< likewise, over every other texel along x
  bool has_squares = false;  ///< all photons are said to bend slowly
};

class DepositTest : public testing::GpuTest {
 protected:
  /// Photons as a function of their place on the grid, both coordinates in [0, 1].
  using Emission = std::function<Photon(double, double)>;

  static std::vector<Photon> emit(const Emission& emission) {
    std::vector<Photon> photons;
    for (std::uint32_t y = 0; y < kGrid; ++y)
      for (std::uint32_t x = 0; x < kGrid; ++x) photons.push_back(emission((x + 0.5) / kGrid, (y + 0.5) / kGrid));
    return photons;
  }

  static Photon makePhoton(double x, double z, vec3 flux = vec3(1.0F, 2.0F, 0.5F)) {
    Photon photon{};
    photon.position = vec3(static_cast<float>(x), 0.0F, static_cast<float>(z));
    photon.direction = normalize(vec3(0.3F, -1.0F, 0.1F));
    photon.flux = flux;
    photon.light_band_flags = packLightBandFlags(0, 0, kPhotonValid);
    photon.chain = 7;
    return photon;
  }

  static std::vector<Photon> emitFar(std::uint32_t seed);
  static std::vector<Photon> emitWide(double growth);

  static Deposited deposit(const std::vector<Photon>& photons, std::span<const ViewRecord> views,
                           const DepositOptions& options = {}) {
    SceneData scene;
    test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.5F)));
    if (options.has_a_plate)
      test::addObject(scene, makeRectangle("plate", dvec3(1, 0.5, 0), dvec3(0, 0, 2), dvec3(1, 0, 0)),
                      test::makeDiffuse(vec3(0.5F)));
    for (int i = 0; options.has_slats && i < static_cast<int>(kSize); i += 2)
      test::addObject(
          scene,
          makeRectangle("slat", dvec3((i + 0.5) * kTexel - 2.002, 0.5, 0), dvec3(0, 0, 2), dvec3(0.5 * kTexel, 0, 0)),
          test::makeDiffuse(vec3(0.5F)));
    const auto view_count = static_cast<std::uint32_t>(views.size());
    gpu::CommandRecorder recorder(device());
    recorder.begin();
    const SceneBuffers buffers(device(), recorder, scene, 0.25F);
    SurfaceLayers layers(device(), buffers, kSize, view_count, 1);
    std::vector<std::size_t> draws(scene.instances.size());
    std::iota(draws.begin(), draws.end(), std::size_t{0});
    layers.record(recorder, views, draws);
    PhotonBuffer buffer(device(), kGrid * kGrid);
    buffer.batch = {.grid_width = kGrid, .grid_height = kGrid, .band_count = 1};
    recorder.upload(buffer.chunks()[0].buffer, std::as_bytes(std::span(photons)));
    if (options.has_squares) {
      buffer.makeSquares(device());
      const std::vector<std::uint32_t> all(std::size_t{buffer.squaresAcross()} * buffer.squaresAcross(), 1);
      recorder.upload(buffer.squares, std::as_bytes(std::span(all)));
    }
    FluxMap map(device(), kSize, kSize, view_count, true);
    map.clear(recorder, 2.0F * kGrid * kGrid);
    const DepositSurfaces surfaces{layers.views(), layers.surfaces(), 1};
    Deposit pass(device(), options.reconstruction, view_count, true);
    pass.record(recorder, buffer, surfaces, 1.0F, 1.5F, map);
    pass.finish(recorder, map);
    LowPass low_pass(device(), view_count, true);
    if (options.low_pass > 0.0F) low_pass.record(recorder, surfaces, options.low_pass, map);
    recorder.submit();
    return read(map, view_count);
  }

  static Deposited read(const FluxMap& map, std::uint32_t views) {
    Deposited result;
    const std::vector<std::byte> bytes = gpu::readBack(device(), map.flux());
    result.steps.resize(bytes.size() / sizeof(std::int32_t));
    std::memcpy(result.steps.data(), bytes.data(), bytes.size());
    constexpr std::size_t kTexels = std::size_t{kSize} * kSize;
    const double quantum = map.quantum();
    for (std::uint32_t v = 0; v < views; ++v)
      for (std::size_t i = 0; i < kTexels; ++i) {
        const auto channel = [&](std::size_t c) { return quantum * result.steps[(v * 6 + c) * kTexels + i]; };
        result.flux.emplace_back(channel(0), channel(1), channel(2));
        result.direction.emplace_back(channel(3), channel(4), channel(5));
      }
    const auto lost = gpu::readBackAs<std::int32_t>(device(), map.lost());
    result.lost = quantum * dvec3(lost[0], lost[1], lost[2]);
    return result;
  }

  static ViewRecord fromAbove() {
    return makeParallelView(vec3(0, -1, 0), Bounds{vec3(-2, -0.1F, -2), vec3(2, 0.6F, 2)});
  }
  static std::vector<ViewRecord> cubeAt(vec3 eye) {
    std::vector<ViewRecord> views;
    for (int face = 0; face < 6; ++face)
      views.push_back(makeCubeView(eye, face, Bounds{vec3(-2, -0.1F, -2), vec3(2, 0.1F, 2)}));
    return views;
  }
};

constexpr double kPhotonCount = double{kGrid} * kGrid;

TEST_F(DepositTest, AnEvenGridGivesAnEvenPicture) {
  // Turned against the texels, by cells of any size against theirs. A row at the rim is not looked at.
  for (const double half : {0.3, 1.1}) {
    const ViewRecord view = fromAbove();
    const double c = std::cos(0.4), s = std::sin(0.4);
    const Deposited found = deposit(emit([&](double u, double v) {
                                      const double x = half * (2.0 * u - 1.0), z = half * (2.0 * v - 1.0);
                                      return makePhoton(c * x - s * z, s * x + c * z);
                                    }),
                                    std::span(&view, 1));
    EXPECT_NEAR(found.total().x / kPhotonCount, 1.0, 1e-5);
    EXPECT_NEAR(found.total().y / kPhotonCount, 2.0, 1e-5);
    EXPECT_NEAR(length(found.lost), 0.0, 1e-9);
    const double texel = kTexel, per_texel = kPhotonCount * texel * texel / (4.0 * half * half);
    for (std::size_t i = 0; i < found.flux.size(); ++i) {
      const double x = (static_cast<double>(i % kSize) + 0.5 - 0.5 * kSize) * texel,
                   y = (static_cast<double>(i / kSize) + 0.5 - 0.5 * kSize) * texel;
      if (std::hypot(x, y) > half - texel) continue;
      ASSERT_NEAR(found.flux[i].x / per_texel, 1.0, 2e-3) << i;
      ASSERT_NEAR(found.direction[i].y / luminance(vec3(found.flux[i])), makePhoton(0, 0).direction.y, 2e-3);
    }
  }
}

TEST_F(DepositTest, FoldsKeepTheirFlux) {
  // The grid is laid over itself along a line, and drawn together into a point and into a line.
  const ViewRecord view = fromAbove();
  const Emission emissions[] = {
      [](double u, double v) { return makePhoton((2.0 * u - 1.0) * (2.0 * u - 1.0), v - 0.5); },
      [](double u, double v) { return makePhoton(std::sin(5.0 * u + v), std::sin(4.0 * v)); },
      [](double, double) { return makePhoton(0.123, 0.456); },
      [](double u, double) { return makePhoton(0.7 * u, 0.31 * u); },
  };
  for (const Emission& emission : emissions) {
    const Deposited found = deposit(emit(emission), std::span(&view, 1));
    EXPECT_NEAR(found.total().x / kPhotonCount, 1.0, 1e-3);
    EXPECT_NEAR(length(found.lost), 0.0, 1e-9);
  }
}

TEST_F(DepositTest, QuadsAndSplatsBringTheSameFlux) {
  // Some photons are missing, others went elsewhere: their cells are torn.
  const ViewRecord view = fromAbove();
  std::vector<Photon> photons = emit([](double u, double v) { return makePhoton(2.4 * u - 1.2, 1.8 * v - 0.9); });
  double valid = 0.0;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    if (i % 7 == 3) photons[i].light_band_flags = packLightBandFlags(0, 0, 0);
    if (i % 5 == 1) photons[i].chain = 9;
    valid += i % 7 == 3 ? 0.0 : 1.0;
  }
  for (const Reconstruction reconstruction : {Reconstruction::kQuads, Reconstruction::kSplats}) {
    const Deposited found = deposit(photons, std::span(&view, 1), {.reconstruction = reconstruction});
    EXPECT_NEAR(found.total().x / valid, 1.0, 1e-4);
    EXPECT_NEAR(length(found.lost), 0.0, 1e-9);
  }
}

TEST_F(DepositTest, TornPhotonsLieAboutWhereTheyEnded) {
  // Each column took another way, so that no cell is whole: a photon is as wide as the next ones of its column are
  // apart.
  const ViewRecord view = fromAbove();
  constexpr double kHalf = 1.1;
  std::vector<Photon> photons =
      emit([](double u, double v) { return makePhoton(kHalf * (2.0 * u - 1.0), kHalf * (2.0 * v - 1.0)); });
  for (std::size_t i = 0; i < photons.size(); ++i) {
    photons[i].chain = static_cast<std::uint32_t>(i % kGrid);
    photons[i].direction = vec3(0, -1, 0);
  }
  const Deposited found = deposit(photons, std::span(&view, 1));
  EXPECT_NEAR(found.total().x / kPhotonCount, 1.0, 1e-5);
  const double per_texel = kPhotonCount * kTexel * kTexel / (4.0 * kHalf * kHalf);
  for (std::size_t i = 0; i < found.flux.size(); ++i) {
    const double x = (static_cast<double>(i % kSize) + 0.5 - 0.5 * kSize) * kTexel,
                 y = (static_cast<double>(i / kSize) + 0.5 - 0.5 * kSize) * kTexel;
    if (std::max(std::abs(x), std::abs(y)) > kHalf - kTexel) continue;
    ASSERT_NEAR(found.flux[i].x / per_texel, 1.0, 2e-3) << i;
  }
}

TEST_F(DepositTest, TornPhotonsUnderGrazingLightStayOnTheirSurface) {
  // Across its column a photon is as wide as it is long, across the light too: half a metre over the floor on one side.
  const ViewRecord view = fromAbove();
  std::vector<Photon> photons = emit([](double u, double v) { return makePhoton(0.2 * u, 1.6 * v - 0.8); });
  for (std::size_t i = 0; i < photons.size(); ++i) {
    photons[i].position.z *= i / kGrid % 2 == 0 ? 1.0F : -1.0F;
    photons[i].chain = static_cast<std::uint32_t>(i % kGrid);
    photons[i].direction = normalize(vec3(1, -0.2F, 0));
  }
  const Deposited found = deposit(photons, std::span(&view, 1));
  EXPECT_NEAR(found.total().x / kPhotonCount, 1.0, 1e-5);
  EXPECT_NEAR(length(found.lost), 0.0, 1e-9);
}

TEST_F(DepositTest, AllFacesOfACubeTogetherHoldTheFlux) {
  // From just above the floor it is seen by five of them, and cells cross their edges. They are up to 17 degrees wide
  // there; what a face's plane makes of so wide a cell is not quite its share.
  const std::vector<ViewRecord> views = cubeAt(vec3(0.1F, 0.4F, -0.2F));
  const Deposited found =
      deposit(emit([](double u, double v) { return makePhoton(3.0 * u - 1.5, 3.0 * v - 1.5); }), views);
  const double texels = static_cast<double>(found.flux.size()) / 6.0;
  std::vector<double> by_face(6, 0.0);
  for (std::size_t i = 0; i < found.flux.size(); ++i)
    by_face[static_cast<std::size_t>(static_cast<double>(i) / texels)] += found.flux[i].x;
  EXPECT_NEAR(found.total().x / kPhotonCount, 1.0, 0.01);
  EXPECT_NEAR(found.lost.x, 0.0, 1e-9);
  for (const int face : {0, 1, 3, 4, 5}) EXPECT_GT(by_face[static_cast<std::size_t>(face)], 10.0) << face;
  EXPECT_EQ(by_face[2], 0.0);
}

TEST_F(DepositTest, WhatIsNotSeenIsLost) {
  const ViewRecord view = fromAbove();
  // A metre under the floor; and on it, but from below.
  const Emission hidden = [](double u, double v) {
    Photon photon = makePhoton(u, v);
    photon.position.y = -1.0F;
    return photon;
  };
  const Emission from_below = [](double u, double v) {
    Photon photon = makePhoton(u, v);
    photon.direction.y = -photon.direction.y;
    return photon;
  };
  for (const Emission& emission : {hidden, from_below}) {
    const Deposited found = deposit(emit(emission), std::span(&view, 1));
    EXPECT_EQ(found.total().x, 0.0);
    EXPECT_NEAR(found.lost.x / kPhotonCount, 1.0, 1e-3);
  }
}

TEST_F(DepositTest, TwoRunsAreEqual) {
  const ViewRecord view = fromAbove();
  const std::vector<Photon> photons =
      emit([](double u, double v) { return makePhoton(std::sin(9.0 * u * v), std::cos(7.0 * u)); });
  EXPECT_EQ(deposit(photons, std::span(&view, 1)).steps, deposit(photons, std::span(&view, 1)).steps);
}

TEST_F(DepositTest, SmallSquaresDoForTheirCells) {
  // Cells of an eighth to a third of a texel, with more flux on one side.
  const ViewRecord view = fromAbove();
  const auto photons = emit([](double u, double v) {
    const auto flux = static_cast<float>(1.0 + 0.5 * u * u + 0.3 * u * v * v);
    return makePhoton(0.2 * u + 0.15 * u * u, 0.3 * v + 0.05 * u * v, flux * vec3(1.0F, 2.0F, 0.5F));
  });
  const Deposited cells = deposit(photons, std::span(&view, 1)),
                  squares = deposit(photons, std::span(&view, 1), {.has_squares = true});
  // Their flux is that of their cells, which are not all alike: to a step of the map for each of them.
  EXPECT_NEAR(squares.total().x / cells.total().x, 1.0, 2e-6);
  EXPECT_NEAR(length(squares.lost), 0.0, 1e-9);
  double off = 0.0;
  for (std::size_t i = 0; i < cells.flux.size(); ++i) off += std::abs(squares.flux[i].x - cells.flux[i].x);
  EXPECT_GT(off, 0.0);
  EXPECT_LT(off, 0.02 * cells.total().x);
}

TEST_F(DepositTest, LargeSquaresAreDepositedCellByCell) {
  const ViewRecord view = fromAbove();
  const auto photons = emit([](double u, double v) { return makePhoton(2.0 * u - 1.0, 1.5 * v + 0.2 * u * u - 1.0); });
  EXPECT_EQ(deposit(photons, std::span(&view, 1), {.has_squares = true}).steps,
            deposit(photons, std::span(&view, 1)).steps);
  // Nor are small ones whose middle lies elsewhere: the grid folds in them.
  const auto folded = emit([](double u, double v) {
    const double x = 6.0 * u - std::floor(6.0 * u);
    return makePhoton(0.12 * std::abs(x - 0.5), 0.2 * v);
  });
  const Deposited squares = deposit(folded, std::span(&view, 1), {.has_squares = true});
  EXPECT_EQ(squares.steps, deposit(folded, std::span(&view, 1)).steps);
}

/// Each photon ends somewhere else, so that cells lie over each other in a hundred layers. Those along the border end
/// in one place: nothing goes on beyond them.
std::vector<Photon> DepositTest::emitFar(std::uint32_t seed) {
  Sampler sampler(seed, 0, 0);
  return emit([&](double u, double v) {
    const vec2 place = 3.8F * sampler.next2D() - 1.9F;
    const bool is_inside = std::max(std::abs(u - 0.5), std::abs(v - 0.5)) < 0.5 - 2.0 / kGrid;
    return is_inside ? makePhoton(place.x, place.y) : makePhoton(0.0, 0.0);
  });
}

TEST_F(DepositTest, FarSpreadLightKeepsItsFlux) {
  const ViewRecord view = fromAbove();
  const Deposited found = deposit(emitFar(0), std::span(&view, 1));
  EXPECT_NEAR(found.total().y / (2.0 * kPhotonCount), 1.0, 1e-5);
  EXPECT_NEAR(length(found.lost), 0.0, 1e-9);
  const Deposited again = deposit(emitFar(0), std::span(&view, 1));
  EXPECT_EQ(found.steps, again.steps);
}

TEST_F(DepositTest, FarSpreadLightKeepsItsMeanOnBrokenSurfaces) {
  // No texel of a coarser level shows one surface, so that cells are drawn by chance to bound the time.
  const ViewRecord view = fromAbove();
  constexpr int kPictures = 12;
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t i = 0; i < kPictures; ++i) {
    const Deposited found = deposit(emitFar(i), std::span(&view, 1), {.has_slats = true});
    const double share = (found.total().y + found.lost.y) / (2.0 * kPhotonCount);
    // Of a wide cell some falls on slats: it is not known to be so near to the floor's plane that it does not.
    EXPECT_GT(found.lost.y, 0.5 * found.total().y);
    sum += share / kPictures, squares += share * share / kPictures;
  }
  const double deviation = std::sqrt((squares - sum * sum) * kPictures / (kPictures - 1));
  EXPECT_NEAR(sum, 1.0, 3.0 * deviation / std::sqrt(double{kPictures}));
  // Some cells count for others, and not too few.
  EXPECT_GT(deviation, 0.01);
  EXPECT_LT(deviation, 0.1);
}

/// Cells ten texels wide and more, far beyond the picture's border, on a grid turned against the texels.
/// @param growth  of their sides across the picture; their flux grows with their area, so that the light is even
std::vector<Photon> DepositTest::emitWide(double growth) {
  const double c = std::cos(0.4), s = std::sin(0.4);
  return emit([&](double u, double v) {
    const double along = 2.0 * u - 1.0, x = 9.0 * (along + 0.5 * growth * along * along), z = 9.0 * (2.0 * v - 1.0);
    const auto flux = static_cast<float>(1.0 + growth * along);
    return makePhoton(c * x - s * z, s * x + c * z, flux * vec3(1.0F, 2.0F, 0.5F));
  });
}

/// W in a texel on which that light falls.
constexpr double kWidePerTexel = kPhotonCount * kTexel * kTexel / (18.0 * 18.0);

TEST_F(DepositTest, AnEvenGridOfLargeCellsGivesAnEvenPicture) {
  const ViewRecord view = fromAbove();
  const Deposited same = deposit(emitWide(0.0), std::span(&view, 1));
  for (const dvec3& flux : same.flux) EXPECT_NEAR(flux.y / (2.0 * kWidePerTexel), 1.0, 2e-3);
  // Where cells of one level border on those of the next.
  const Deposited growing = deposit(emitWide(0.7), std::span(&view, 1));
  double mean = 0.0;
  for (const dvec3& flux : growing.flux) {
    EXPECT_NEAR(flux.y / (2.0 * kWidePerTexel), 1.0, 0.06);
    mean += flux.y / (2.0 * kWidePerTexel) / static_cast<double>(growing.flux.size());
  }
  EXPECT_NEAR(mean, 1.0, 0.01);
}

TEST_F(DepositTest, LargeCellsEndAtEdges) {
  // All light falls on the floor, half of which is hidden by a plate.
  const ViewRecord view = fromAbove();
  const Deposited found = deposit(emitWide(0.0), std::span(&view, 1), {.has_a_plate = true});
  for (std::size_t i = 0; i < found.flux.size(); ++i) {
    const bool is_floor = i % kSize < kSize / 2;
    EXPECT_NEAR(found.flux[i].y / (2.0 * kWidePerTexel), is_floor ? 1.0 : 0.0, 2e-3) << i;
  }
  EXPECT_NEAR(found.lost.y / found.total().y, 1.0, 2e-3);
}

TEST_F(DepositTest, NegativeFluxOfBandsIsSubtracted) {
  const ViewRecord view = fromAbove();
  const Deposited found = deposit(
      emit([](double u, double v) { return makePhoton(2.0 * u - 1.0, 2.0 * v - 1.0, vec3(1.0F, -0.25F, 0.0F)); }),
      std::span(&view, 1));
  EXPECT_NEAR(found.total().y / kPhotonCount, -0.25, 1e-5);
  EXPECT_EQ(found.total().z, 0.0);
}

/// Sums of each channel of the map, in steps.
std::vector<std::int64_t> sumSteps(const Deposited& found) {
  constexpr std::size_t kTexels = std::size_t{kSize} * kSize;
  std::vector<std::int64_t> sums(found.steps.size() / kTexels, 0);
  for (std::size_t i = 0; i < found.steps.size(); ++i) sums[i / kTexels] += found.steps[i];
  return sums;
}

TEST_F(DepositTest, ALowPassMakesASpikeItsKernel) {
  const ViewRecord view = fromAbove();
  const std::vector<Photon> spike = emit([](double, double) { return makePhoton(0.123, 0.456); });
  constexpr double kDeviation = 1.7;
  const Deposited before = deposit(spike, std::span(&view, 1));
  const Deposited after = deposit(spike, std::span(&view, 1), {.low_pass = static_cast<float>(kDeviation)});
  const auto middle = static_cast<std::size_t>(
      std::ranges::max_element(before.flux, {}, [](const dvec3& f) { return f.x; }) - before.flux.begin());
  ASSERT_NEAR(before.flux[middle].x / before.total().x, 1.0, 1e-12);
  constexpr int kReach = 6;
  double sum = 0.0;
  for (int i = -kReach; i <= kReach; ++i) sum += std::exp(-0.5 * i * i / (kDeviation * kDeviation));
  for (int y = -kReach; y <= kReach; ++y)
    for (int x = -kReach; x <= kReach; ++x) {
      const double weight = std::exp(-0.5 * (x * x + y * y) / (kDeviation * kDeviation)) / (sum * sum);
      const std::size_t at = middle + static_cast<std::size_t>(y * static_cast<int>(kSize) + x);
      EXPECT_NEAR(after.flux[at].y / before.total().y, weight, 1e-6) << x << " " << y;
    }
  EXPECT_EQ(sumSteps(after), sumSteps(before));
}

TEST_F(DepositTest, ALowPassKeepsTheFluxOfEachSurface) {
  // Up to the border of the picture, and on both sides of the plate's edge; of bands whose flux is negative too.
  const std::vector<Photon> photons = emit([](double u, double v) {
    Photon photon = makePhoton(3.9 * u - 1.95, 3.9 * v - 1.95, vec3(1.0F, -0.25F, 3.0F));
    if (photon.position.x > 0.0F) photon.position.y = 0.5F, photon.chain = 8;
    return photon;
  });
  const ViewRecord above = makeParallelView(vec3(0, -1, 0), Bounds{vec3(-2, -0.1F, -2), vec3(2, 0.6F, 2)});
  const std::vector<ViewRecord> cube = cubeAt(vec3(-0.3F, 0.9F, 0.2F));
  for (const std::span<const ViewRecord> views : {std::span(&above, 1), std::span(cube)}) {
    const Deposited before = deposit(photons, views, {.has_a_plate = true});
    const Deposited after = deposit(photons, views, {.low_pass = 2.5F, .has_a_plate = true});
    EXPECT_EQ(sumSteps(after), sumSteps(before));
    EXPECT_NE(after.steps, before.steps);
    if (views.size() > 1) continue;
    // The plate's edge is in the middle of the picture.
    std::int64_t left_before = 0, left_after = 0;
    for (std::size_t i = 0; i < std::size_t{kSize} * kSize; ++i) {
      const vec3 right = normalize(above.right);
      const double column = (static_cast<double>(i % kSize) + 0.5) / kSize - 0.5;
      const double row = 0.5 - (static_cast<double>(i / kSize) + 0.5) / kSize;
      if (column * right.x + row * normalize(above.up).x > 0.0) continue;
      left_before += before.steps[i], left_after += after.steps[i];
    }
    EXPECT_GT(left_before, 0);
    EXPECT_EQ(left_after, left_before);
  }
}

}  // namespace
}  // namespace nephroid

// The first light of a scene with the pictures that its light is followed in, for tests of transport.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "frame/emission.shared.h"
#include "frame/light_views.h"
#include "techniques/caustic_map/emission_views.h"
#include "techniques/caustic_map/photon_ledger.h"
#include "techniques/caustic_map/transport.h"
#include "trace/box_tree_builder.h"

namespace nephroid::testing {

struct Flown {
  std::vector<Photon> photons;
  std::map<std::uint32_t, int> outcomes;

  static std::uint32_t outcomeOf(const Photon& p) { return photonFlags(p) >> kOutcomeShift; }

  /// Of all photons that ended so, W.
  dvec3 fluxOf(std::uint32_t outcome) const {
    dvec3 sum(0.0);
    for (const Photon& p : photons)
      if (outcomeOf(p) == outcome) sum += dvec3(p.flux);
    return sum;
  }
  /// Of all that met a generator, W.
  dvec3 fluxAfterGenerators() const {
    dvec3 sum(0.0);
    for (const Photon& p : photons)
      if (outcomeOf(p) != kOutcomeMissed && outcomeOf(p) != kOutcomeBlocked) sum += dvec3(p.flux);
    return sum;
  }
};

class LightRig {
 public:
  /// @param grid   of the emission, and texels along a side of all pictures
  LightRig(gpu::Device& device, const SceneData& scene, std::uint32_t grid = 128, std::uint32_t layers = 4)
      : device_(device),
        scene_(scene),
        grid_(grid),
        view_(*LightViews(scene, 0).make(0, 0)),
        hull_(makeHull(scene)),
        views_(makeEmissionViews(view_.light, hull_, scene.bounds())),
        recorder_(device),
        buffers_(device, recorder_, scene, 0.25F),
        first_(device, buffers_, grid, viewCount(), 1),
        inner_(device, buffers_, grid, viewCount(), layers),
        outer_(device, buffers_, grid, static_cast<std::uint32_t>(view_.views.size()), 2),
        photons_(device, grid * grid),
        tree_(device, recorder_, scene, buildBoxTree),
        transport_(device, buffers_),
        cell_lists_(transport_.makeCellLists(grid)) {
    std::vector<std::size_t> all, generators, receivers;
    for (std::size_t i = 0; i < buffers_.draws().size(); ++i) {
      all.push_back(i);
      if (buffers_.draws()[i].generates) generators.push_back(i);
      if (!buffers_.draws()[i].generates) receivers.push_back(i);
    }
    first_.record(recorder_, views_, all);
    inner_.record(recorder_, views_, generators);
    outer_.record(recorder_, view_.views, receivers);
    lights_ = gpu::makeBuffer<LightRecord>(device, recorder_, std::span(&view_.light, 1),
                                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "lights");
    recorder_.submit();
  }

  /// Photons through one view of the emission.
  Flown fly(TransportSettings settings, std::uint32_t view = 0) {
    settings.grid = grid_;
    recorder_.begin();
    transport_.record(recorder_, pictures(), lights_, 0, view, settings, photons_);
    recorder_.submit();
    return read();
  }

  /// Likewise, by lists of cells, after the branches before.
  Flown flyListed(TransportSettings settings, std::uint32_t view = 0) {
    settings.grid = grid_;
    settings.cell_lists = &cell_lists_;
    const std::uint32_t branch = settings.branch;
    recorder_.begin();
    for (settings.branch = 0; settings.branch <= branch; ++settings.branch)
      transport_.record(recorder_, pictures(), lights_, 0, view, settings, photons_);
    recorder_.submit();
    return read();
  }

  /// Cells that the last flight by lists followed in a branch.
  std::uint32_t followed(std::uint32_t branch) {
    const std::vector<CellListHead> heads = gpu::readBackAs<CellListHead>(device_, cell_lists_.cells);
    std::uint32_t sum = 0;
    for (std::uint32_t k = 0; k < kListsEach; ++k) sum += heads[branch * kListsEach + k].count;
    return sum;
  }

  /// Of all views and of branches 0 to `last`, and of the weaker way if that is to be followed.
  Ledger ledger(std::uint32_t last, TransportSettings settings = {}) {
    PhotonLedger ledger(device_, grid_ * grid_, viewCount() * (last + 2));
    const bool follows_weaker = std::exchange(settings.follows_weaker, false);
    settings.grid = grid_;
    settings.account = &ledger.account();
    recorder_.begin();
    for (std::uint32_t view = 0; view < viewCount(); ++view) {
      const auto run = [&] {
        transport_.record(recorder_, pictures(), lights_, 0, view, settings, photons_);
        ledger.record(recorder_, photons_, grid_ * grid_, 0, settings.branch);
      };
      settings.follows_weaker = false;
      for (settings.branch = 0; settings.branch <= last; ++settings.branch) {
        settings.is_last = settings.branch == last;
        run();
      }
      if (!follows_weaker) continue;
      settings.branch = 1;
      settings.is_last = settings.follows_weaker = true;
      run();
    }
    recorder_.submit();
    return ledger.read(0);
  }

  LightPictures pictures() const {
    return {views_, hull_.bounds(), scene_.bounds(), view_.views, first_, inner_, outer_, &tree_};
  }
  const std::vector<ViewRecord>& views() const { return views_; }
  std::uint32_t viewCount() const { return static_cast<std::uint32_t>(views_.size()); }
  const LightRecord& light() const { return view_.light; }

  /// Middle of a photon's cell on the film, in [-1, 1]².
  vec2 filmOf(const Photon& p) const {
    return (vec2(p.index % grid_, p.index / grid_) + 0.5F) * 2.0F / static_cast<float>(grid_) - 1.0F;
  }
  /// Where its ray starts, in a picture of parallel light.
  vec3 startOf(const Photon& p) const {
    const vec2 film = filmOf(p);
    return views_[0].eye + film.x * views_[0].right - film.y * views_[0].up;
  }
  /// Area of a cell of parallel light, m².
  double cellArea() const {
    return 4.0 * length(views_[0].right) * length(views_[0].up) / static_cast<double>(grid_ * grid_);
  }
  /// Flux that leaves the light through one view, W.
  dvec3 emitted(std::uint32_t view = 0) const {
    dvec3 sum(0.0);
    const float share = 1.0F / static_cast<float>(grid_ * grid_);
    for (std::uint32_t i = 0; i < grid_ * grid_; ++i) {
      Photon p{};
      p.index = i;
      const vec2 film = filmOf(p);
      sum += dvec3(cellFlux(view_.light, views_[view], film.x, film.y, share));
    }
    return sum;
  }

 private:
  /// Recording begins before the scene is uploaded.
  struct Recorder : gpu::CommandRecorder {
    explicit Recorder(gpu::Device& device) : gpu::CommandRecorder(device) { begin(); }
  };

  static GeneratorHull makeHull(const SceneData& scene) {
    MeshTrees trees;
    return makeGeneratorHull(scene, 0.25F, trees);
  }

  Flown read() {
    Flown flown;
    flown.photons = readPhotons(device_, photons_);
    for (const Photon& p : flown.photons) ++flown.outcomes[Flown::outcomeOf(p)];
    return flown;
  }

  gpu::Device& device_;
  const SceneData& scene_;
  std::uint32_t grid_;
  LightView view_;
  GeneratorHull hull_;
  std::vector<ViewRecord> views_;
  Recorder recorder_;
  SceneBuffers buffers_;
  SurfaceLayers first_, inner_, outer_;
  PhotonBuffer photons_;
  TriangleTree tree_;
  Transport transport_;
  CellLists cell_lists_;
  gpu::Buffer lights_;
};

}  // namespace nephroid::testing

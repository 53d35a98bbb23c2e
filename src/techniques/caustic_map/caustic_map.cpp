#include "techniques/caustic_map/caustic_map.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "core/sampling/sampler.h"
#include "core/spectrum.h"
#include "frame/emission.shared.h"
#include "frame/surface_layers.h"
#include "techniques/caustic_map/emission_views.h"
#include "techniques/caustic_map/settings.h"
#include "techniques/realtime/realtime_render.h"

namespace nephroid {

/// Photons of one run of transport.
struct CausticMap::Photons {
  PhotonBuffer ends;
  std::optional<Landings> landings;  ///< where some generators are receivers too
};

/// What becomes of photons where they end, and of those that paths leave on generators.
struct CausticMap::Sink {
  std::function<void(const PhotonBuffer&)> end, land;
};

/// What one point or direction of light sees, and what is deposited there.
struct CausticMap::Pictures {
  std::vector<ViewRecord> emission;
  gpu::Buffer light;  ///< a LightRecord
  /// The last two where it is in them that light is followed; the last one also if maps are made.
  std::unique_ptr<SurfaceLayers> first, generators, receivers;
  /// Generators that are receivers too: in the picture of the others they would hide what light reaches through them.
  std::unique_ptr<SurfaceLayers> both;
  FluxMap map, map_of_both;
  bool receivers_are_drawn = false;  ///< and both
  bool maps_are_kept = false;        ///< what is in them is what would be put there
  std::deque<Photons> photons;       ///< that are kept, one for each run of transport
};

struct CausticMap::Source {
  std::unique_ptr<Pictures> pictures;
  bool is_new = true;      ///< what stays was not drawn yet
  float most_flux = 0.0F;  ///< of its last point that was new, W
};

struct CausticMap::Point {
  LightView view;
  Source* source;
  std::vector<ViewRecord> emission;  ///< if it is new
  float most_flux;                   ///< W
  float weight;                      ///< of all points of its source
  bool is_new;                       ///< its pictures are
};

namespace {

/// Stream of the sampler for places in cells, far from those of lights.
constexpr std::uint32_t kCellStream = 0xCA057000U;
/// Cells along a side of a view over which its flux is added up to bound it, and by how much the sum may be too small.
constexpr int kBoundCells = 32;
constexpr float kBoundMargin = 1.02F;

/// No less than what a light sends through its views in all bands, signs left out, W, of the largest channel.
float boundFlux(LightRecord light, const std::vector<ViewRecord>& views, const std::vector<Band>& bands) {
  // Of all directions and sides: what is cut out of that is less.
  if (light.kind == kLightSpot) light.kind = kLightPoint;
  light.surface = kSurfaceNone;
  float sum = 0.0F;
  for (const ViewRecord& view : views)
    for (int y = 0; y < kBoundCells; ++y)
      for (int x = 0; x < kBoundCells; ++x) {
        const auto film = [](int i) { return (static_cast<float>(i) + 0.5F) * 2.0F / kBoundCells - 1.0F; };
        const vec3 flux = cellFlux(light, view, film(x), film(y), 1.0F / (kBoundCells * kBoundCells));
        sum += std::max({flux.x, flux.y, flux.z});
      }
  vec3 weights(0.0F);
  for (const Band& band : bands) weights += glm::abs(band.weight);
  return kBoundMargin * sum * std::max({weights.x, weights.y, weights.z});
}

std::uint32_t countOf(const std::vector<ViewRecord>& views) { return static_cast<std::uint32_t>(views.size()); }

/// Who embeds the frame may have no builder for the tree.
CausticMapSettings withoutTree(CausticMapSettings settings, const RealtimeInputs& inputs) {
  if (settings.search == Search::kTree && !inputs.tree) settings.search = Search::kPlanes;
  return settings;
}

/// Layers of pictures for at least so many views.
void makeRoom(std::unique_ptr<SurfaceLayers>& layers, const RealtimeInputs& inputs, std::uint32_t size,
              std::uint32_t views, std::uint32_t count) {
  if (layers && layers->roomForViews() >= views) return;
  layers = std::make_unique<SurfaceLayers>(inputs.device, inputs.buffers, size, views, count);
}

}  // namespace

CausticMap::CausticMap(const RealtimeInputs& inputs, const CausticMapSettings& settings)
    : inputs_(inputs),
      settings_(withoutTree(settings, inputs)),
      directions_(inputs.buffers.traits().gloss || inputs.buffers.traits().metal),
      transport_(inputs.device, inputs.buffers),
      cell_lists_(transport_.makeCellLists(settings.grid)),
      bands_(inputs.buffers.traits().specular.disperses ? makeBands(static_cast<int>(settings.bands))
                                                        : std::vector<Band>{{0.0F, vec3(1.0F)}}),
      photons_(std::make_unique<Photons>(makePhotons())) {
  makeSources();
}

CausticMap::~CausticMap() = default;

CausticMap::Photons CausticMap::makePhotons() const {
  const auto make = [&] {
    PhotonBuffer photons(inputs_.device, settings_.grid * settings_.grid, settings_.grid);
    photons.batch = {.emitted_count = photons.capacity(),
                     .grid_width = settings_.grid,
                     .grid_height = settings_.grid,
                     .band_count = static_cast<std::uint32_t>(bands_.size())};
    if (settings_.photon_spacing >= kDepositSquare) photons.makeSquares(inputs_.device);
    return photons;
  };
  Photons photons{make(), std::nullopt};
  if (!transport_.lands()) return photons;
  for (PhotonBuffer& landings : photons.landings.emplace()) landings = make();
  return photons;
}

void CausticMap::makeSources() {
  const std::vector<SceneBuffers::Draw>& draws = inputs_.buffers.draws();
  all_.clear(), generators_.clear(), receivers_.clear(), both_.clear();
  for (std::size_t i = 0; i < draws.size(); ++i) {
    all_.push_back(i);
    if (draws[i].generates) generators_.push_back(i);
    // What catches nothing still stops light.
    if (!draws[i].generates) receivers_.push_back(i);
    if (draws[i].generates && draws[i].receives) both_.push_back(i);
  }
  generator_hull_ = makeGeneratorHull(inputs_.scene, inputs_.specular_alpha, mesh_trees_);
  scene_bounds_ = inputs_.scene.bounds();
  tree_ = searchesPictures() ? nullptr : &inputs_.tree();
  lights_ = std::make_unique<LightViews>(inputs_.scene, inputs_.seed);
  sources_.resize(lights_->count());
  for (Source& source : sources_) source.is_new = true;
}

void CausticMap::lightChanged(std::size_t index) {
  sources_[index].is_new = true;
  receiver_map_is_kept_ = false;
}

void CausticMap::objectsMoved() {
  makeSources();
  receiver_map_.reset();
}

const ReceiverMap* CausticMap::lightReceivers() {
  if (!receiver_map_) {
    receiver_map_ = std::make_unique<ReceiverMap>(inputs_.device, inputs_.scene, inputs_.buffers,
                                                  ReceiverMapSettings{.size = settings_.receiver_map_size,
                                                                      .reconstruction = settings_.reconstruction,
                                                                      .splat_radius = settings_.splat_radius,
                                                                      .directions = directions_});
    receiver_map_is_kept_ = false;
  }
  return receiver_map_.get();
}

dvec3 CausticMap::lostByReceivers() { return receiver_map_ ? receiver_map_->readLost(inputs_.device) : dvec3(0.0); }

bool CausticMap::beginReceivers(gpu::CommandRecorder& recorder, const RealtimeSample& sample,
                                const std::vector<Point>& points) {
  // Somebody else's pictures have no mirrors of ours.
  if (!receiver_map_ || sample.surfaces.isForeign() || receiver_map_is_kept_) return false;
  receiver_map_is_kept_ = std::ranges::all_of(points, [&](const Point& point) { return keeps(point); });
  float most = 0.0F;
  for (const Point& point : points) most += point.weight * point.most_flux;
  receiver_map_->clear(recorder, most);
  return true;
}

Deposit& CausticMap::deposit(std::uint32_t views) {
  const std::size_t index = views > 1 ? 1 : 0;
  if (deposits_.size() <= index) deposits_.resize(index + 1);
  if (!deposits_[index])
    deposits_[index] = std::make_unique<Deposit>(inputs_.device, settings_.reconstruction, views, directions_);
  return *deposits_[index];
}

void CausticMap::smooth(gpu::CommandRecorder& recorder, const DepositSurfaces& surfaces, std::uint32_t views,
                        const FluxMap& map) {
  if (!(settings_.low_pass > 0.0F)) return;
  const std::size_t index = views > 1 ? 1 : 0;
  if (low_passes_.size() <= index) low_passes_.resize(index + 1);
  if (!low_passes_[index]) low_passes_[index] = std::make_unique<LowPass>(inputs_.device, views, directions_);
  low_passes_[index]->record(recorder, surfaces, settings_.low_pass, map);
}

LookUp& CausticMap::lookUp(bool foreign, std::uint32_t views) {
  const std::size_t index = (foreign ? 2U : 0U) + (views > 1 ? 1U : 0U);
  if (look_ups_.size() <= index) look_ups_.resize(index + 1);
  if (!look_ups_[index])
    look_ups_[index] = std::make_unique<LookUp>(inputs_.device, inputs_.buffers, foreign, views, directions_);
  return *look_ups_[index];
}

CausticMap::Point CausticMap::makePoint(const LightView& view, Source& source, float weight) const {
  Point point{view, &source, {}, 0.0F, weight, view.varies || source.is_new};
  if (point.is_new) {
    point.emission = makeEmissionViews(view.light, generator_hull_, scene_bounds_);
    source.most_flux = boundFlux(view.light, point.emission, bands_);
    // The light of a path falls on all that it meets.
    if (transport_.lands()) source.most_flux *= 1.0F + static_cast<float>(kLandings);
  }
  point.most_flux = source.most_flux;
  return point;
}

std::vector<CausticMap::Point> CausticMap::choosePoints(std::uint32_t sample) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    Source& source = sources_[i];
    std::optional<LightView> view = lights_->make(i, sample);
    if (!view) continue;
    if (!view->varies) {
      points.push_back(makePoint(*view, source, 1.0F));
      source.is_new = false;
      continue;
    }
    const bool is_environment = i >= inputs_.scene.lights.size() && view->light.kind == kLightDirectional;
    const std::uint32_t count = is_environment ? settings_.directions : settings_.points;
    for (std::uint32_t k = 0; k < count; ++k) {
      view = lights_->make(i, sample * count + k);
      if (view) points.push_back(makePoint(*view, source, 1.0F / static_cast<float>(count)));
    }
  }
  return points;
}

void CausticMap::record(gpu::CommandRecorder& recorder, const RealtimeSample& sample) {
  if (generator_hull_.empty()) return;
  const std::vector<Point> points = choosePoints(sample.index);
  // Somebody else's pictures say where their pixels are, but not the way back.
  const bool into_pixels = settings_.target == DepositTarget::kCamera && !sample.surfaces.isForeign();
  if (into_pixels) {
    float most = 0.0F;
    for (const Point& point : points) most += sample.weight * point.weight * point.most_flux;
    if (!pixel_deposit_) pixel_deposit_ = std::make_unique<PixelDeposit>(inputs_.device, inputs_.buffers, directions_);
    pixel_deposit_->begin(recorder, sample, most);
  }
  const bool into_receivers = beginReceivers(recorder, sample, points);
  for (const Point& point : points) {
    std::unique_ptr<Pictures>& pictures = point.source->pictures;
    if (!pictures) pictures = std::make_unique<Pictures>();
    if (point.is_new) recordPictures(recorder, point, *pictures);
    if (pictures->emission.empty()) continue;
    Sinks sinks;
    if (into_receivers) {
      const auto add = [&](const PhotonBuffer& photons) { receiver_map_->add(recorder, photons, point.weight); };
      sinks.push_back({add, add});
    }
    if (!into_pixels) {
      recordMaps(recorder, sample, point, std::move(sinks));
      continue;
    }
    const auto add = [&](const PhotonBuffer& photons) {
      deposit(1).record(recorder, photons, pixel_deposit_->surfaces(sample), sample.weight * point.weight,
                        settings_.splat_radius, pixel_deposit_->map());
    };
    sinks.push_back({add, add});
    emit(recorder, sample.index, point, sinks);
  }
  if (into_receivers) receiver_map_->finish(recorder);
  if (!into_pixels) return;
  deposit(1).finish(recorder, pixel_deposit_->map());
  smooth(recorder, pixel_deposit_->surfaces(sample), 1, pixel_deposit_->map());
  pixel_deposit_->finish(recorder, sample);
}

void CausticMap::recordMaps(gpu::CommandRecorder& recorder, const RealtimeSample& sample, const Point& point,
                            Sinks sinks) {
  Pictures& pictures = *point.source->pictures;
  if (!pictures.receivers_are_drawn) recordReceivers(recorder, point, pictures);
  struct Map {
    DepositSurfaces surfaces;
    FluxMap* flux;
  };
  std::vector<Map> maps{
      {{pictures.receivers->views(), pictures.receivers->surfaces(), settings_.receiver_layers}, &pictures.map}};
  if (pictures.both) maps.push_back({{pictures.both->views(), pictures.both->surfaces()}, &pictures.map_of_both});
  const std::uint32_t views = point.view.light.view_count, size = pictures.receivers->size();
  const bool are_filled = !pictures.maps_are_kept;
  if (are_filled) {
    for (const Map& map : maps) {
      if (!map.flux->valid()) *map.flux = FluxMap(inputs_.device, size, size, views, directions_);
      map.flux->clear(recorder, point.most_flux);
    }
    const auto addTo = [&](const Map& map) {
      return [&](const PhotonBuffer& photons) {
        deposit(views).record(recorder, photons, map.surfaces, 1.0F, settings_.splat_radius, *map.flux);
      };
    };
    // Without a map of generators that are receivers too nothing lands on them.
    sinks.push_back({addTo(maps.front()), addTo(maps.back())});
  }
  emit(recorder, sample.index, point, sinks);
  for (const Map& map : maps) {
    if (are_filled) {
      deposit(views).finish(recorder, *map.flux);
      smooth(recorder, map.surfaces, views, *map.flux);
    }
    lookUp(sample.surfaces.isForeign(), views)
        .record(recorder, sample, sample.weight * point.weight, map.surfaces, *map.flux);
  }
  if (are_filled) pictures.maps_are_kept = keeps(point);
}

void CausticMap::recordPictures(gpu::CommandRecorder& recorder, const Point& point, Pictures& pictures) {
  const LightView& view = point.view;
  pictures.emission = point.emission;
  pictures.maps_are_kept = false;
  pictures.photons.clear();
  if (pictures.emission.empty()) return;
  if (!pictures.light.valid())
    pictures.light = gpu::Buffer(inputs_.device, sizeof(LightRecord), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                 gpu::MemoryIntent::kDevice, "light of a caustic map");
  recorder.upload(pictures.light, std::as_bytes(std::span(&view.light, 1)));
  const std::uint32_t views = countOf(pictures.emission);
  makeRoom(pictures.first, inputs_, settings_.grid, views, 1);
  pictures.first->record(recorder, pictures.emission, all_);
  if (searchesPictures() || settings_.exit == Exit::kWyman) {
    makeRoom(pictures.generators, inputs_, settings_.grid, views, settings_.layers);
    pictures.generators->record(recorder, pictures.emission, generators_);
  }
  pictures.receivers_are_drawn = false;
  if (searchesPictures()) recordReceivers(recorder, point, pictures);
}

void CausticMap::recordReceivers(gpu::CommandRecorder& recorder, const Point& point, Pictures& pictures) {
  const std::uint32_t views = point.view.light.view_count;
  const std::uint32_t size = views > 1 ? settings_.map_size : settings_.sun_map_size;
  makeRoom(pictures.receivers, inputs_, size, views, settings_.receiver_layers);
  pictures.receivers->record(recorder, point.view.views, receivers_);
  pictures.receivers_are_drawn = true;
  if (!transport_.lands()) return;
  makeRoom(pictures.both, inputs_, size, views, 1);
  pictures.both->record(recorder, point.view.views, both_);
}

bool CausticMap::keeps(const Point& point) const { return settings_.emits_once && !point.view.varies; }

void CausticMap::emit(gpu::CommandRecorder& recorder, std::uint32_t sample, const Point& point, const Sinks& sinks) {
  if (sinks.empty()) return;
  const auto use = [&](const Photons& photons) {
    for (const Sink& sink : sinks) {
      sink.end(photons.ends);
      if (!photons.landings) continue;
      for (const PhotonBuffer& landings : *photons.landings) sink.land(landings);
    }
  };
  if (!keeps(point)) {
    follow(
        recorder, sample, point, [&]() -> Photons& { return *photons_; }, nullptr, use);
    return;
  }
  std::deque<Photons>& kept = point.source->pictures->photons;
  if (kept.empty())
    follow(
        recorder, 0, point, [&]() -> Photons& { return kept.emplace_back(makePhotons()); }, nullptr,
        [](const Photons&) {});
  for (const Photons& photons : kept) use(photons);
}

void CausticMap::follow(gpu::CommandRecorder& recorder, std::uint32_t sample, const Point& point,
                        const std::function<Photons&()>& next, PhotonLedger* ledger,
                        const std::function<void(const Photons&)>& use) {
  const Pictures& pictures = *point.source->pictures;
  const auto orFirst = [&](const std::unique_ptr<SurfaceLayers>& layers, bool is_searched) -> const SurfaceLayers& {
    return is_searched ? *layers : *pictures.first;
  };
  const LightPictures followed{pictures.emission,
                               generator_hull_.bounds(),
                               scene_bounds_,
                               point.view.views,
                               *pictures.first,
                               orFirst(pictures.generators, searchesPictures() || settings_.exit == Exit::kWyman),
                               orFirst(pictures.receivers, searchesPictures()),
                               tree_};
  Sampler sampler(inputs_.seed, kCellStream, sample);
  // Mirrors let nothing in.
  const std::uint32_t last = inputs_.buffers.traits().specular.transmits ? 1 + settings_.internal_reflections : 0;
  TransportSettings transport{.grid = settings_.grid,
                              // The first sample is that of the cells' middles, as a single picture should be.
                              .offset = sample == 0 ? vec2(0.5F) : sampler.next2D(),
                              .max_events = settings_.max_events,
                              .seed = hashChain(inputs_.seed, sample),
                              .iterations = settings_.iterations,
                              .receiver_iterations = settings_.receiver_iterations,
                              .search = settings_.search,
                              .exit = settings_.exit,
                              .flux = settings_.flux,
                              .first_guess = settings_.first_guess,
                              .account = ledger ? &ledger->account() : nullptr,
                              .cell_lists = ledger ? nullptr : &cell_lists_,
                              .spacing = settings_.weaker_ways ? 1 : settings_.photon_spacing,
                              .specular_alpha = inputs_.specular_alpha};
  for (transport.band_index = 0; transport.band_index < bands_.size(); ++transport.band_index) {
    transport.band = bands_[transport.band_index];
    for (std::uint32_t v = 0; v < countOf(pictures.emission); ++v) {
      const auto run = [&] {
        const Photons& photons = next();
        if (photons.landings && !ledger) transport.landings = &*photons.landings;
        transport_.record(recorder, followed, pictures.light, 0, v, transport, photons.ends);
        if (ledger) ledger->record(recorder, photons.ends, photons.ends.capacity(), 0, transport.branch);
        use(photons);
      };
      transport.follows_weaker = false;
      for (transport.branch = 0; transport.branch <= last; ++transport.branch) {
        transport.is_last = transport.branch == last;
        run();
      }
      // Where nothing lets light through there is but one way.
      if (!settings_.weaker_ways || last == 0) continue;
      transport.branch = 1;
      transport.is_last = transport.follows_weaker = true;
      run();
    }
  }
}

std::vector<Ledger> CausticMap::account() {
  std::vector<Ledger> ledgers;
  if (generator_hull_.empty()) return ledgers;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    ledgers.emplace_back();
    ledgers.back().light = i < inputs_.scene.lights.size() ? inputs_.scene.lights[i].name : "emission";
  }
  const auto bands = static_cast<std::uint32_t>(bands_.size());
  PhotonLedger ledger(inputs_.device, photons_->ends.capacity(),
                      bands * kMostViews * (3 + settings_.internal_reflections));
  gpu::CommandRecorder recorder(inputs_.device);
  for (const Point& point : choosePoints(0)) {
    std::unique_ptr<Pictures>& pictures = point.source->pictures;
    if (!pictures) pictures = std::make_unique<Pictures>();
    recorder.begin();
    if (point.is_new) recordPictures(recorder, point, *pictures);
    ledger.begin();
    follow(
        recorder, 0, point, [&]() -> Photons& { return *photons_; }, &ledger, [](const Photons&) {});
    recorder.submit();
    recorder.wait();
    Ledger of_point = ledger.read(0);
    of_point.scale(point.weight);
    ledgers[static_cast<std::size_t>(point.source - sources_.data())].add(of_point);
  }
  return ledgers;
}

namespace {

std::unique_ptr<RealtimeTechnique> makeCausticMap(const RealtimeInputs& inputs, const ParamSet& params) {
  if (std::ranges::none_of(inputs.buffers.draws(), &SceneBuffers::Draw::generates)) return nullptr;
  return std::make_unique<CausticMap>(inputs, makeCausticMapSettings(params));
}

RenderResult renderCausticMap(const SceneData& scene, const Camera& camera, const RenderSettings& settings,
                              ProgressSink* progress, const StopToken* stop) {
  return renderRealtime(findTechnique("caustic-map"), scene, camera, settings, progress, stop);
}

}  // namespace

Technique makeCausticMapTechnique() {
  Technique technique;
  technique.name = "caustic-map";
  technique.text =
      "caustics in real time, on a Vulkan device: photons from a grid over what bends light are followed through "
      "glass, off metal and into water, and deposited into the camera's pixels, or into a map in the light's view";
  technique.source = "Shah, Konttinen, Pattanaik 2007";
  technique.on_vulkan = true;
  technique.params = makeCausticMapParams();
  technique.make_realtime = makeCausticMap;
  technique.lights_receivers = true;
  technique.account = [](RealtimeTechnique& drawn) { return static_cast<CausticMap&>(drawn).account(); };
  technique.render = renderCausticMap;
  return technique;
}

}  // namespace nephroid

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
  std::unique_ptr<SurfaceLayers> first, generators, receivers;
  /// Generators that are receivers too: in the picture of the others they would hide what light reaches through them.
  std::unique_ptr<SurfaceLayers> both;
  FluxMap map, map_of_both;
  bool maps_are_kept = false;   ///< what is in them is what would be put there
  std::deque<Photons> photons;  ///< that are kept, one for each run of transport
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

/// Layers of pictures for at least so many views.
void makeRoom(std::unique_ptr<SurfaceLayers>& layers, const RealtimeInputs& inputs, std::uint32_t size,
              std::uint32_t views, std::uint32_t count) {
  if (layers && layers->roomForViews() >= views) return;
  layers = std::make_unique<SurfaceLayers>(inputs.device, inputs.buffers, size, views, count);
}

}  // namespace

CausticMap::CausticMap(const RealtimeInputs& inputs, const CausticMapSettings& settings)
    : inputs_(inputs),
      settings_(settings),
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
  low_passes_[index]->record(recorder, surfaces, settings_.low_pass, inputs_.buffers.sampler(), map);
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
                        settings_.splat_radius, inputs_.buffers.sampler(), pixel_deposit_->map());
    };
    sinks.push_back({add, add});
    emit(recorder, sample.index, point, sinks);
  }
  if (!into_pixels) return;
  smooth(recorder, pixel_deposit_->surfaces(sample), 1, pixel_deposit_->map());
  pixel_deposit_->finish(recorder, sample);
}

void CausticMap::recordMaps(gpu::CommandRecorder& recorder, const RealtimeSample& sample, const Point& point,
                            Sinks sinks) {
  Pictures& pictures = *point.source->pictures;
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
        deposit(views).record(recorder, photons, map.surfaces, 1.0F, settings_.splat_radius, inputs_.buffers.sampler(),
                              *map.flux);
      };
    };
    // Without a map of generators that are receivers too nothing lands on them.
    sinks.push_back({addTo(maps.front()), addTo(maps.back())});
  }
  emit(recorder, sample.index, point, sinks);
  for (const Map& map : maps) {
    if (are_filled) smooth(recorder, map.surfaces, views, *map.flux);
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
  const std::uint32_t views = countOf(pictures.emission), map_views = view.light.view_count;
  const std::uint32_t size = map_views > 1 ? settings_.map_size : settings_.sun_map_size;
  makeRoom(pictures.first, inputs_, settings_.grid, views, 1);
  makeRoom(pictures.generators, inputs_, settings_.grid, views, settings_.layers);
  makeRoom(pictures.receivers, inputs_, size, map_views, settings_.receiver_layers);
  pictures.first->record(recorder, pictures.emission, all_);
  pictures.generators->record(recorder, pictures.emission, generators_);
  pictures.receivers->record(recorder, view.views, receivers_);
  if (!transport_.lands()) return;
  makeRoom(pictures.both, inputs_, size, map_views, 1);
  pictures.both->record(recorder, view.views, both_);
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
  const LightPictures followed{pictures.emission, generator_hull_.bounds(), scene_bounds_,      point.view.views,
                               *pictures.first,   *pictures.generators,     *pictures.receivers};
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
  constexpr std::uint32_t kMostViews = 6;
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

std::vector<ParamSpec> makeParams() {
  const CausticMapSettings defaults;
  const auto number = [](std::uint32_t value) { return static_cast<int>(value); };
  std::vector<ParamSpec> params = makeFrameParams();
  const std::vector<ParamSpec> own{
      {"grid",
       number(defaults.grid),
       8,
       2048,
       "cells",
       "along a side of each picture that a light takes of what bends it; a photon a cell",
       {}},
      {"map-size",
       number(defaults.map_size),
       16,
       2048,
       "texels",
       "along a side of each face of the cube map that the light of a point is deposited into",
       {}},
      {"sun-map-size",
       number(defaults.sun_map_size),
       16,
       4096,
       "texels",
       "along a side of the map that parallel light is deposited into",
       {}},
      {"receiver-map-size",
       number(defaults.receiver_map_size),
       16,
       2048,
       "texels",
       "along a side of each view along an axis, into which light is deposited for what mirrors and glass show; fewer "
       "where "
       "a million would not do for all views",
       {}},
      {"layers",
       number(defaults.layers),
       1,
       16,
       "",
       "surfaces behind one another, as seen from the light, that light is followed through",
       {}},
      {"receiver-layers",
       number(defaults.receiver_layers),
       1,
       16,
       "",
       "surfaces behind one another, as seen from the light, that light may end on",
       {}},
      {"internal-reflections",
       number(defaults.internal_reflections),
       0,
       8,
       "",
       "inside a solid that are followed before light leaves it",
       {}},
      {"weaker-ways",
       defaults.weaker_ways,
       0,
       0,
       "",
       "whether the weaker of two ways is followed too, the first time that light which enters a solid and leaves it "
       "has "
       "both: hollow bodies, several bodies behind one another",
       {}},
      {"iterations", number(defaults.iterations), 1, 64, "", "to find where a ray meets what bends it", {}},
      {"receiver-iterations", number(defaults.receiver_iterations), 1, 64, "", "to find where it ends", {}},
      {"search",
       std::string("planes"),
       0,
       0,
       "",
       "how the receiver is found: Newton's method on the planes of texels, from steps along the ray on; or as the "
       "paper "
       "and those it compares with do",
       {"planes", "iterate", "newton", "secant", "march"}},
      {"exit",
       std::string("planes"),
       0,
       0,
       "",
       "how the back face is found: as receivers are, or by Wyman's approximation",
       {"planes", "wyman"}},
      {"flux",
       std::string("beam"),
       0,
       0,
       "",
       "what a photon carries: the light's flux through its cell; or, for comparison, that times the cosine at the "
       "surface, as eq. 6 of the paper has it, with which a sphere loses a third of its flux",
       {"beam", "eq6"}},
      {"first-guess",
       0.0F,
       0,
       1e6,
       "m",
       "of the distance, for all but planes and march; 0: what is seen where the ray starts",
       {}},
      {"bands",
       number(defaults.bands),
       1,
       12,
       "",
       "of wavelength that are followed, where a material disperses light",
       {}},
      {"points", number(defaults.points), 1, 256, "", "that a light with a size is taken for, each sample", {}},
      {"directions", number(defaults.directions), 1, 1024, "", "that the environment is taken for, each sample", {}},
      {"reconstruct",
       std::string("quads"),
       0,
       0,
       "",
       "how flux is spread: over the cells between photons, or each photon as a Gaussian splat",
       {"quads", "splats"}},
      {"target",
       std::string("camera"),
       0,
       0,
       "",
       "the picture that photons are deposited into: the camera's own pixels, or a map in the light's view",
       {"camera", "light"}},
      {"emit",
       std::string("every-frame"),
       0,
       0,
       "",
       "whether lights without a size send other photons in each sample, or keep them until something changes",
       {"every-frame", "once"}},
      {"splat-radius", defaults.splat_radius, 0.5, 32, "texels", "of a splat", {}},
      {"low-pass",
       defaults.low_pass,
       0,
       16,
       "texels",
       "standard deviation of a Gaussian that blurs what was deposited and keeps the flux of each surface, in the "
       "light's map or in the camera's pixels; 0: none",
       {}},
  };
  params.insert(params.end(), own.begin(), own.end());
  return params;
}

Search searchOf(const std::string& name) {
  if (name == "iterate") return Search::kIterate;
  if (name == "newton") return Search::kNewton;
  if (name == "secant") return Search::kSecant;
  if (name == "march") return Search::kMarch;
  return Search::kPlanes;
}

CausticMapSettings makeSettings(const ParamSet& params) {
  const auto count = [&](const char* name) { return static_cast<std::uint32_t>(params.getInt(name)); };
  CausticMapSettings settings;
  settings.grid = count("grid");
  settings.map_size = count("map-size");
  settings.sun_map_size = count("sun-map-size");
  settings.receiver_map_size = count("receiver-map-size");
  settings.layers = count("layers");
  settings.receiver_layers = count("receiver-layers");
  settings.internal_reflections = count("internal-reflections");
  settings.weaker_ways = params.getBool("weaker-ways");
  settings.iterations = count("iterations");
  settings.receiver_iterations = count("receiver-iterations");
  settings.search = searchOf(params.getString("search"));
  settings.exit = params.getString("exit") == "wyman" ? Exit::kWyman : Exit::kPlanes;
  if (params.getString("flux") == "eq6") settings.flux = CellFlux::kEq6;
  settings.first_guess = params.getFloat("first-guess");
  settings.bands = count("bands");
  settings.points = count("points");
  settings.directions = count("directions");
  if (params.getString("reconstruct") == "splats") settings.reconstruction = Reconstruction::kSplats;
  if (params.getString("target") == "light") settings.target = DepositTarget::kLight;
  settings.emits_once = params.getString("emit") == "once";
  settings.splat_radius = params.getFloat("splat-radius");
  settings.low_pass = params.getFloat("low-pass");
  return settings;
}

std::unique_ptr<RealtimeTechnique> makeCausticMap(const RealtimeInputs& inputs, const ParamSet& params) {
  if (std::ranges::none_of(inputs.buffers.draws(), &SceneBuffers::Draw::generates)) return nullptr;
  return std::make_unique<CausticMap>(inputs, makeSettings(params));
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
      "caustics in real time, on a Vulkan device: light is followed through glass, off metal and into water in the "
      "pictures that it takes of the scene, and deposited into a map in its own view";
  technique.source = "Shah, Konttinen, Pattanaik 2007";
  technique.on_vulkan = true;
  technique.params = makeParams();
  technique.make_realtime = makeCausticMap;
  technique.lights_receivers = true;
  technique.account = [](RealtimeTechnique& drawn) { return static_cast<CausticMap&>(drawn).account(); };
  technique.render = renderCausticMap;
  return technique;
}

}  // namespace nephroid

// Caustic maps: light followed from grids over what bends it, deposited into the pixels or into the light's view
// ([shah-caustics-mapping]).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/spectrum.h"
#include "frame/deposit.h"
#include "frame/light_views.h"
#include "frame/low_pass.h"
#include "frame/pixel_deposit.h"
#include "frame/realtime_technique.h"
#include "frame/receiver_map.h"
#include "techniques/caustic_map/generator_hull.h"
#include "techniques/caustic_map/look_up.h"
#include "techniques/caustic_map/photon_ledger.h"
#include "techniques/caustic_map/settings.h"
#include "techniques/caustic_map/transport.h"
#include "techniques/technique.h"

namespace nephroid {

/// One map for each light, or for each point of it, drawn and looked up in one sample.
class CausticMap : public RealtimeTechnique {
 public:
  /// @throws ResourceError
  CausticMap(const RealtimeInputs& inputs, const CausticMapSettings& settings);
  ~CausticMap() override;

  void record(gpu::CommandRecorder& recorder, const RealtimeSample& sample) override;
  const ReceiverMap* lightReceivers() override;
  dvec3 lostByReceivers() override;
  void lightChanged(std::size_t index) override;
  void objectsMoved() override;

  /// What becomes of the light of the first sample, by source. Waits for the device.
  /// @throws ResourceError
  std::vector<Ledger> account();

 private:
  struct Photons;
  struct Sink;
  struct Pictures;
  /// What is followed in one sample of one source of light.
  struct Source;
  void makeSources();
  /// A point or a direction of a source in one sample.
  struct Point;
  std::vector<Point> choosePoints(std::uint32_t sample);
  /// Of a source that stays, its views are fitted only when it is new.
  Point makePoint(const LightView& view, Source& source, float weight) const;
  void recordPictures(gpu::CommandRecorder& recorder, const Point& point, Pictures& pictures);
  /// What else the light sees than what bends it, for maps and where light is followed in pictures.
  void recordReceivers(gpu::CommandRecorder& recorder, const Point& point, Pictures& pictures);
  bool searchesPictures() const { return settings_.search != Search::kTree; }
  /// From the light to where its photons end, one view, branch and band after the other.
  /// @param next    where the next photons are written
  /// @param ledger  null: nobody asks what becomes of them
  /// @param use     called when they are
  void follow(gpu::CommandRecorder& recorder, std::uint32_t sample, const Point& point,
              const std::function<Photons&()>& next, PhotonLedger* ledger,
              const std::function<void(const Photons&)>& use);
  /// What becomes of the photons of one point.
  using Sinks = std::vector<Sink>;
  /// Likewise without a ledger, or what was kept, if it goes anywhere.
  void emit(gpu::CommandRecorder& recorder, std::uint32_t sample, const Point& point, const Sinks& sinks);
  /// Puts all that the points send on receivers into their map, unless it is there already.
  /// @return  whether photons are to be added
  bool beginReceivers(gpu::CommandRecorder& recorder, const RealtimeSample& sample, const std::vector<Point>& points);
  /// Puts what a point sends into the maps of its own view, unless it is there already, and looks them up.
  /// @param sinks  where else it goes
  void recordMaps(gpu::CommandRecorder& recorder, const RealtimeSample& sample, const Point& point, Sinks sinks);
  bool keeps(const Point& point) const;
  Photons makePhotons() const;
  LookUp& lookUp(bool foreign, std::uint32_t views);
  Deposit& deposit(std::uint32_t views);
  /// Blurs a map, if it is to be.
  void smooth(gpu::CommandRecorder& recorder, const DepositSurfaces& surfaces, std::uint32_t views, const FluxMap& map);

  RealtimeInputs inputs_;
  CausticMapSettings settings_;
  bool directions_;                                        ///< surfaces ask where light comes from
  std::vector<std::size_t> all_, generators_, receivers_;  ///< of the scene's draws
  std::vector<std::size_t> both_;                          ///< generators that are receivers too
  MeshTrees mesh_trees_;
  GeneratorHull generator_hull_;
  Bounds scene_bounds_;
  const TriangleTree* tree_ = nullptr;  ///< if it is searched
  std::unique_ptr<LightViews> lights_;
  Transport transport_;
  CellLists cell_lists_;
  std::vector<Band> bands_;                      ///< one for all where nothing disperses light
  std::unique_ptr<Photons> photons_;             ///< of what is not kept
  std::unique_ptr<PixelDeposit> pixel_deposit_;  ///< where pixels are deposited into
  std::vector<std::unique_ptr<Deposit>> deposits_;
  std::vector<std::unique_ptr<LowPass>> low_passes_;
  std::vector<std::unique_ptr<LookUp>> look_ups_;
  std::unique_ptr<ReceiverMap> receiver_map_;  ///< once it is asked for
  bool receiver_map_is_kept_ = false;          ///< what is in the map is what would be put there
  std::vector<Source> sources_;
};

Technique makeCausticMapTechnique();

}  // namespace nephroid

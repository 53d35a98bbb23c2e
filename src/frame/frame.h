// The real-time frame: what the camera sees, lit, as layers. Everything of the picture but the caustic.
//
// A frame is one sample of each pixel and of each light. One frame is a real-time picture; the mean of many, each with
// another place in the pixel and on the lights, converges to what the reference renders.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/box_tree.h"
#include "core/image/image.h"
#include "core/optics/surface.shared.h"
#include "frame/caustic_pass.h"
#include "frame/display_pass.h"
#include "frame/foreign_lighting.h"
#include "frame/light_grids.h"
#include "frame/raster.h"
#include "frame/realtime_technique.h"
#include "frame/sample_push.shared.h"
#include "frame/scene_buffers.h"
#include "frame/shade_pass.h"
#include "frame/specular_pass.h"
#include "gpu/commands.h"

namespace nephroid {

struct FrameSettings {
  int width = 1024, height = 768;
  std::uint32_t shadow_size = 256;  ///< cells along a side of each view of a light that varies; bears on speed only
  float specular_alpha = 0.25F;     ///< microfacets finer than this are class S
  bool specular = true;             ///< makes that layer, which takes longer than all others
  BoxTreeBuilder box_tree_builder;  ///< for `specular`, which is not made without one, and for techniques
  std::uint32_t max_events = 12;    ///< of class S, in what is seen in mirrors and through glass
  std::uint32_t specular_spacing =
      4;  ///< pixels between those from which mirrors and glass are followed, 1 to 4; 1: all
  std::uint32_t seed = 0;
  Rasteriser rasteriser = Rasteriser::kAuto;
  Shading shading = Shading::kAuto;
};

/// Not thread-safe. Device and scene must outlive it. The scene's owner may edit it between frames if he tells by
/// `lightChanged` or `objectsMoved`; other changes need a new frame.
class RealtimeFrame {
 public:
  /// Uploads the scene and makes what all frames need.
  /// @param make_technique  what draws the caustic; empty: none
  /// @throws ResourceError
  RealtimeFrame(gpu::Device& device, const SceneData& scene, const Camera& camera, const FrameSettings& settings,
                const MakeRealtimeTechnique& make_technique = {});
  ~RealtimeFrame();

  /// As FrameSettings::specular, from now on: whoever learns late that he wants the layer. Starts the sums again.
  /// @throws ResourceError
  void addSpecular();
  void setCamera(const Camera& camera);
  /// @throws ResourceError
  void resize(int width, int height);
  /// One of SceneData::lights is another now. Only what its own shadows are asked from is made again.
  void lightChanged(std::size_t index);
  /// Instances stand elsewhere now. Uploads where they stand; meshes and materials stay.
  void objectsMoved();

  /// Draws sample `sample` and adds it to the layers that are summed. Waits until the device is done.
  void render(std::uint32_t sample);
  /// Starts the sums again.
  void reset();
  std::uint32_t samples() const { return samples_; }
  /// What draws the caustic; null if there is nothing to draw.
  RealtimeTechnique* technique() const { return technique_.get(); }
  /// Of the last frame, by pass; those of lights' grids come first.
  const std::vector<gpu::PassTime>& passTimes() const { return times_; }

  /// Mean of a layer over the samples since `reset`: "direct", "caustic", "specular", "emission" and, not summed,
  /// "specular_caustic" and "irradiance_caustic". Black if the frame does not make it.
  Image readSummed(const std::string& layer);
  /// A layer of the geometry at the pixels' centres: "albedo", "normal", "position", "depth", "id".
  Image readGeometry(const std::string& layer);

  /// The sum of such layers (of "direct", "caustic", "specular", "emission") as an image on the device, submitted but
  /// not waited for. Valid until the next call or `resize`. @param display  empty: radiance as it is
  const gpu::Image& compose(std::span<const std::string> layers, const std::optional<FrameDisplay>& display);

  /// Records nothing of this frame's own picture: adds sample `sample` of the light on somebody else's to `target`.
  /// Waits until the device is done.
  void lightForeign(const ForeignPicture& picture, const IrradianceImages& target, const ForeignLight& light,
                    std::uint32_t sample, float weight);

 private:
  struct Passes;
  struct PassablePush;
  void uploadEnvironment();
  void uploadLamps();
  void makeTargets();
  void makePasses();
  ShadingInputs shadingInputs() const;
  void makeTechnique(const MakeRealtimeTechnique& make);
  /// Of the scene as it stands, made once it is asked for.
  const TriangleTree& triangleTree();
  void makeSpecular();
  /// FrameSettings::specular_spacing, or 1 where the scene forbids cells.
  std::uint32_t specularSpacing() const;
  void makeCaustic();
  /// Null if the frame does not make it.
  const gpu::Image* sumOf(const std::string& layer) const;
  std::vector<const gpu::Image*> sums() const;
  /// Of frame/sky.glsl and frame/lights.glsl: what shines, as it was when the passes were compiled.
  std::vector<gpu::Constant> lightConstants() const;
  /// Whether the passes that are compiled know all that shines now.
  bool lightsAreCompiled() const;
  void recordVisibility(vec2 film_offset, std::uint32_t frame, bool geometry_only);
  void recordTint(vec2 film_offset, std::uint32_t frame);
  SamplePush samplePush(vec2 film_offset, std::uint32_t frame) const;
  void recordCaustic(std::uint32_t frame);
  /// @param draws  of the scene, by index
  void drawScene(gpu::PassCommands& commands, const std::vector<std::size_t>& draws);
  std::vector<gpu::Use> drawUses(std::initializer_list<gpu::Use> targets) const;
  PassablePush passablePush(vec2 film_offset, std::uint32_t frame, bool geometry_only) const;

  gpu::Device& device_;
  const SceneData& scene_;
  Camera camera_;
  FrameSettings settings_;
  Bounds bounds_;
  gpu::CommandRecorder recorder_;
  std::unique_ptr<SceneBuffers> buffers_;
  std::unique_ptr<LightGrids> light_grids_;
  std::unique_ptr<Passes> passes_;
  std::unique_ptr<ComputeRaster> raster_;  ///< where it is used
  std::unique_ptr<TriangleTree> tree_;     ///< null: nobody has asked for it
  std::unique_ptr<ShadePass> shade_;
  std::unique_ptr<RealtimeTechnique> technique_;  ///< null: none, or it has nothing to draw
  std::unique_ptr<SpecularPass> specular_;        ///< null: nobody has asked for it
  std::unique_ptr<CausticPass> caustic_;          ///< where there is one
  std::unique_ptr<DisplayPass> display_;          ///< once somebody asked for it
  std::unique_ptr<ForeignLighting> foreign_;      ///< likewise
  ViewRecord view_{};
  DrawSplit split_;
  gpu::Buffer camera_view_;
  gpu::Image seen_, depth_, tint_, environment_, nothing_;
  gpu::Buffer lamps_;
  gpu::Sampler environment_sampler_;
  std::uint32_t lamp_count_ = 0;
  bool lamps_compiled_ = false;
  LightTraits lights_compiled_;
  std::vector<gpu::PassTime> times_;
  std::uint32_t samples_ = 0;
};

/// What the scene asks for and a frame of these settings does not do, a sentence each.
/// @param lights_receivers  its technique says what mirrors and glass show of caustics
std::vector<std::string> describeFrameLimits(const SceneData& scene, const FrameSettings& settings,
                                             bool lights_receivers = false);

}  // namespace nephroid

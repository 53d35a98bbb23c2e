// A still picture by a real-time technique: as many frames as were asked for, and their mean as layers.
#pragma once

#include <vector>

#include "frame/frame.h"
#include "techniques/technique.h"

namespace nephroid {

/// Parameters of the frame, which all real-time techniques have.
std::vector<ParamSpec> makeFrameParams();
/// What they say; size, seed and layers are the caller's.
FrameSettings makeFrameSettings(const ParamSet& params);
/// What the frame is given for the technique's caustic; empty if it makes none.
MakeRealtimeTechnique factoryOf(const Technique& technique, const ParamSet& params);

/// Technique::render of every real-time technique.
RenderResult renderRealtime(const Technique& technique, const SceneData& scene, const Camera& camera,
                            const RenderSettings& settings, ProgressSink* progress, const StopToken* stop);

}  // namespace nephroid

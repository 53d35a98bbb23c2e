#include "techniques/none/none.h"

#include "techniques/realtime/realtime_render.h"

namespace nephroid {
namespace {

RenderResult renderNone(const SceneData& scene, const Camera& camera, const RenderSettings& settings,
                        ProgressSink* progress, const StopToken* stop) {
  return renderRealtime(findTechnique("none"), scene, camera, settings, progress, stop);
}

}  // namespace

Technique makeNoneTechnique() {
  Technique technique;
  technique.name = "none";
  technique.text =
      "the real-time frame without any caustic, on a Vulkan device: direct, emission, specular and the geometry's "
      "layers; what the real-time techniques add their caustics to";
  technique.source = "Burns & Hunt 2013; Appel 1968";
  technique.on_vulkan = true;
  technique.params = makeFrameParams();
  technique.render = renderNone;
  return technique;
}

}  // namespace nephroid

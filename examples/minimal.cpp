// Renders a built-in scene, reads a layer and writes a picture: the whole API in one sitting.
#include <algorithm>
#include <cstdio>

#include "nephroid/nephroid.h"

int main() {
  try {
    // A scene is a .glb or .gltf file, or one of the built-in ones ("nephroid scenes" lists them).
    nephroid::Scene scene = nephroid::Scene::load("builtin:ring");

    // Layers split the light by the path it took: `caustic` is what mirrors and glass throw onto other things.
    nephroid::RenderRequest request;
    request.width = 320;
    request.height = 240;
    request.layers = {"beauty", "caustic"};
    request.samples = 4;
    request.photons = 200'000;
    const nephroid::Picture picture = nephroid::render(scene, request);

    // Pixels are linear radiance in W/m²/sr, row 0 on top.
    const nephroid::LayerView caustic = picture.layer("caustic");
    std::printf("brightest caustic: %g W/m^2/sr\n", *std::max_element(caustic.pixels.begin(), caustic.pixels.end()));
    picture.writePng("ring.png");
  } catch (const nephroid::Error& error) {
    // Every message is one line that says what was found and what to do.
    std::fprintf(stderr, "error: %s\n", error.what());
    return static_cast<int>(error.exitCode());
  }
}

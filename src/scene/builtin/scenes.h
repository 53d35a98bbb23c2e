// The constructors of the built-in scenes' entries, each in the file named after it.
#pragma once

#include "scene/builtin/builtin.h"

namespace nephroid {

BuiltinScene describeRingScene();
BuiltinScene describeSphereScene();
BuiltinScene describeSphereBoxScene();
BuiltinScene describeSphereInBoxScene();
BuiltinScene describeCognacScene();
BuiltinScene describeWaveScene();
BuiltinScene describeCubeScene();
BuiltinScene describePrismScene();
BuiltinScene describeBuildingScene();
BuiltinScene describePoolScene();
BuiltinScene describeSeabedScene();
BuiltinScene describeCoffeeScene();
BuiltinScene describeSlabScene();
BuiltinScene describeObjectScene();

}  // namespace nephroid

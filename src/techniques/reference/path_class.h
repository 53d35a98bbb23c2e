// Which layer a path belongs to, decided from its events as it grows from the eye (DESIGN §2, "Layers").
#pragma once

#include <cstdint>

#include "trace/bsdf.h"

namespace nephroid {

/// The layers that partition all paths; kSpecularCaustic is a part of kSpecular that is also shown on its own.
enum class PathLayer : std::uint8_t { kEmission, kDirect, kCaustic, kSpecular, kIndirect };

/// The events of a path so far, x_n (next to the eye) first.
class PathClass {
 public:
  void add(EventClass event) {
    const bool specular = event == EventClass::kSpecular;
    if (count_ == 0) {
      first_specular_ = specular;
      stage_ = specular ? Stage::kEyeSide : Stage::kOther;
    } else {
      later_all_specular_ = later_all_specular_ && specular;
      switch (stage_) {
        case Stage::kEyeSide:
          if (!specular) stage_ = Stage::kReceiver;
          break;
        case Stage::kReceiver:
        case Stage::kLightSide:
          stage_ = specular ? Stage::kLightSide : Stage::kOther;
          break;
        case Stage::kOther:
          break;
      }
    }
    last_specular_ = specular;
    ++count_;
    if (!specular) ++diffuse_count_;
  }
  PathClass with(EventClass event) const {
    PathClass copy = *this;
    copy.add(event);
    return copy;
  }

  int count() const { return count_; }
  int diffuseCount() const { return diffuse_count_; }
  bool firstIsSpecular() const { return count_ > 0 && first_specular_; }
  bool firstIsDiffuse() const { return count_ > 0 && !first_specular_; }
  /// With more S alone it becomes L S⁺ D E, or is that already.
  bool mayBecomeCaustic() const { return firstIsDiffuse() && later_all_specular_; }
  /// With more events it becomes L S⁺ D S⁺ E, or is that already.
  bool mayBecomeSpecularCaustic() const { return first_specular_ && stage_ != Stage::kOther; }
  PathLayer layer() const {
    if (count_ == 0) return PathLayer::kEmission;
    if (first_specular_) return PathLayer::kSpecular;
    if (count_ == 1) return PathLayer::kDirect;
    return later_all_specular_ ? PathLayer::kCaustic : PathLayer::kIndirect;
  }
  /// L S⁺ D S⁺ E: a caustic seen in a mirror or through glass.
  bool isSpecularCaustic() const { return stage_ == Stage::kLightSide; }
  /// Nothing but mirrors and glass so far, and at least one.
  bool isEyeSpecular() const { return stage_ == Stage::kEyeSide; }
  /// L S … D E: found by light tracing, whose photons first meet something specular and end on what the eye sees.
  bool isLightTraced() const { return firstIsDiffuse() && last_specular_; }
  /// L S … D … D S⁺ E, at least two D: what a caustic lights in turn, seen in a mirror or through glass. From the eye:
  /// S⁺, then D, then anything with a further D in it, then S. A photon leaves its light by S and has met a D before it
  /// comes to the D that the eye meets first; each such path has one such D, so it is gathered once.
  bool isSpecularIndirect() const { return first_specular_ && last_specular_ && diffuse_count_ > 1; }

 private:
  enum class Stage : std::uint8_t { kEyeSide, kReceiver, kLightSide, kOther };
  int count_ = 0, diffuse_count_ = 0;
  bool first_specular_ = false, last_specular_ = false, later_all_specular_ = true;
  Stage stage_ = Stage::kOther;
};

/// Kinds of paths whose light begins with S, by whether photons make them; what they do not make, paths from the eye
/// find by chance.
struct PhotonPaths {
  bool caustic = false;            ///< L S⁺ D E
  bool indirect = false;           ///< L S … D … D E
  bool specular_caustic = false;   ///< L S⁺ D S⁺ E
  bool specular_indirect = false;  ///< L S … D … D S⁺ E

  bool include(const PathClass& path) const {
    if (path.isLightTraced()) return path.layer() == PathLayer::kCaustic ? caustic : indirect;
    return (specular_caustic && path.isSpecularCaustic()) || (specular_indirect && path.isSpecularIndirect());
  }
};

}  // namespace nephroid

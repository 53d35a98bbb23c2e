// Which solids a point is inside of: the interior list of nested dielectrics.
//
// Followed along a path by the side of the geometric normal at which it meets each interface, so closed solids, solids
// in solids and open interfaces (a water surface) need no further marking. Where solids overlap, the one of highest
// `priority` rules, among equals the one entered last; the others' interfaces inside it are no events
// (Schmidt & Budge 2002, "Simple nested dielectrics in ray traced images", with the last-entered rule added).
#pragma once

#include <cstdint>

#include "scene/scene_data.h"

namespace nephroid {

class InteriorList {
 public:
  /// Solids nested deeper than this are counted as lost: no real scene comes near.
  static constexpr int kCapacity = 8;

  struct Entry {
    std::uint32_t solid;  ///< TraceScene::solidOf
    const Material* material;
  };

  int count() const { return count_; }
  bool contains(std::uint32_t solid) const { return find(solid) >= 0; }

  /// The solid whose medium fills the place, leaving out `except`; null in the open.
  const Material* medium(std::uint32_t except = kNone) const {
    const Material* best = nullptr;
    for (int i = 0; i < count_; ++i)
      if (entries_[i].solid != except && (!best || entries_[i].material->priority >= best->priority))
        best = entries_[i].material;
    return best;
  }
  /// True if `solid`, which is in the list, is the one that `medium()` names.
  bool rules(std::uint32_t solid) const {
    int best = -1;
    for (int i = 0; i < count_; ++i)
      if (best < 0 || entries_[i].material->priority >= entries_[best].material->priority) best = i;
    return best >= 0 && entries_[best].solid == solid;
  }

  /// @return false if the list is full
  bool enter(std::uint32_t solid, const Material& material) {
    if (count_ == kCapacity) return false;
    entries_[count_++] = {solid, &material};
    return true;
  }
  /// Removes the latest entry of `solid`, if any.
  void leave(std::uint32_t solid) {
    const int at = find(solid);
    if (at < 0) return;
    for (int i = at; i + 1 < count_; ++i) entries_[i] = entries_[i + 1];
    --count_;
  }

 private:
  int find(std::uint32_t solid) const {
    for (int i = count_ - 1; i >= 0; --i)
      if (entries_[i].solid == solid) return i;
    return -1;
  }
  Entry entries_[kCapacity];
  int count_ = 0;
};

/// What a path finds at the boundary of a solid.
struct Interface {
  const Material* from = nullptr;  ///< medium on the side that the path comes from; null: vacuum
  const Material* to = nullptr;    ///< medium behind; null: vacuum
  bool entering = false;
  bool is_event = true;  ///< false: hidden inside a solid that rules; the path goes straight on
};

/// Does each wavelength go its own way there?
inline bool isDispersive(const Interface& boundary) {
  return (boundary.from && boundary.from->dispersion > 0.0F) || (boundary.to && boundary.to->dispersion > 0.0F);
}

/// @param entering  the path meets the outer side of the solid's surface
inline Interface findInterface(const InteriorList& interior, std::uint32_t solid, const Material& material,
                               bool entering) {
  Interface result;
  result.entering = entering;
  if (entering) {
    result.from = interior.medium();
    result.to = &material;
    result.is_event = !result.from || material.priority >= result.from->priority;
  } else {
    result.from = &material;
    result.to = interior.medium(solid);
    // Not in the list: the path started inside, or the interface is open. Then it ruled all along.
    result.is_event = !interior.contains(solid) || interior.rules(solid);
  }
  return result;
}

/// After the path has gone through. @return false if the list is full
inline bool crossInterface(InteriorList& interior, std::uint32_t solid, const Material& material, bool entering) {
  if (entering) return interior.enter(solid, material);
  interior.leave(solid);
  return true;
}

/// After the path was reflected: from the inside of a solid that was not listed, it is now known to be inside.
inline bool reflectInside(InteriorList& interior, std::uint32_t solid, const Material& material, bool entering) {
  if (entering || interior.contains(solid)) return true;
  return interior.enter(solid, material);
}

}  // namespace nephroid

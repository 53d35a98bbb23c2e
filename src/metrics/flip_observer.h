// What FLIP's observer sees of a picture, and how much it differs from what is seen of another.
#pragma once

#include "metrics/separable_filter.h"

namespace nephroid {

/// Some rows of a picture in opponent colours (perceived_colour.h).
struct OpponentPlanes {
  Plane luminance, red_green, blue_yellow;

  OpponentPlanes(int width, int height)
      : luminance(width, height), red_green(width, height), blue_yellow(width, height) {}
};

/// What is seen of them.
struct Percept {
  OpponentPlanes colour;     ///< without details too fine to be seen
  Plane edges_x, edges_y;    ///< how much brighter it is on one side than on the other; white after black is ±116
  Plane points_x, points_y;  ///< how much brighter or darker the sides are than what lies between

  Percept(int width, int height)
      : colour(width, height),
        edges_x(width, height),
        edges_y(width, height),
        points_x(width, height),
        points_y(width, height) {}
};

/// An eye at a distance from a screen, after [andersson-2020].
class FlipObserver {
 public:
  explicit FlipObserver(float pixels_per_degree);

  /// Rows and columns that are needed on each side of those that are seen.
  int border() const { return border_; }
  /// @param shown    with the border
  /// @param percept  without; written
  void look(const OpponentPlanes& shown, Percept& percept) const;

 private:
  void lookAtColours(const OpponentPlanes& shown, OpponentPlanes& seen) const;
  void lookForFeatures(const Plane& luminance, Percept& percept) const;

  int border_;
  Kernel luminance_, red_green_;
  Kernel blue_yellow_, blue_yellow_wide_;  ///< the sum of the two, by their shares
  float blue_yellow_share_, blue_yellow_wide_share_;
  Kernel smooth_, slope_, curvature_;  ///< of features
};

/// FLIP of the pixel in column `x` of row `y`, in [0, 1]; the same if the two are exchanged.
float computeFlip(const Percept& a, const Percept& b, int x, int y);

}  // namespace nephroid

#include "core/optics/fresnel_average.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/optics/fresnel.shared.h"

namespace nephroid {
namespace {

/// Positive nodes and weights of the 16-point Gauss–Legendre rule on [−1, 1] (Abramowitz and Stegun, table 25.4).
constexpr std::array<std::array<double, 2>, 8> kGaussLegendre16{{{0.0950125098376374, 0.1894506104550685},
                                                                 {0.2816035507792589, 0.1826034150449236},
                                                                 {0.4580167776572274, 0.1691565193950025},
                                                                 {0.6178762444026438, 0.1495959888165767},
                                                                 {0.7554044083550030, 0.1246289712555339},
                                                                 {0.8656312023878318, 0.0951585116824928},
                                                                 {0.9445750230732326, 0.0622535239386479},
                                                                 {0.9894009349916499, 0.0271524594117541}}};

template <class Function>
double integrate(double from, double to, const Function& f) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (const auto& [node, weight] : kGaussLegendre16)
    sum += weight * (f(middle - half * node) + f(middle + half * node));
  return half * sum;
}

}  // namespace

float averageFresnelDielectric(float ior) {
  const float ior_ratio = 1.0F / ior;
  // Light that enters a thinner medium is reflected whole below this cosine.
  const double cos_critical = ior < 1.0F ? std::sqrt((1.0 - ior) * (1.0 + ior)) : 0.0;
  // F has a square-root singularity at the critical cosine (and nearly one at grazing incidence when ior is close to
  // 1). In s with c = cos_critical + (1 − cos_critical)·s⁴ it is smooth enough for the rule.
  const double span = 1.0 - cos_critical;
  const double smooth = integrate(0.0, 1.0, [&](double s) {
    const double c = cos_critical + span * s * s * s * s;
    return fresnelDielectric(static_cast<float>(c), ior_ratio) * c * span * 4.0 * s * s * s;
  });
  return static_cast<float>(std::clamp(cos_critical * cos_critical + 2.0 * smooth, 0.0, 1.0));
}

}  // namespace nephroid

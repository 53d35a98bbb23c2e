#include "core/spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/assert.h"
#include "core/sampling/distribution.h"

namespace nephroid {
namespace {

constexpr int kCells = 340;  // of 1 nm: far finer than the narrowest lobe of the fit (σ = 11.8 nm)
static_assert(kWavelengthMax_nm - kWavelengthMin_nm == kCells);

/// A Gaussian with one width on each side.
double lobe(double x, double peak, double sigma_below, double sigma_above) {
  const double t = (x - peak) / (x < peak ? sigma_below : sigma_above);
  return std::exp(-0.5 * t * t);
}

dvec3 computeColourMatching(double nm) {
  return {
      1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) - 0.065 * lobe(nm, 501.1, 20.4, 26.2),
      0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
      1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

/// CIE XYZ to linear Rec. 709 with white point D65 (IEC 61966-2-1).
dvec3 toRec709(dvec3 xyz) {
  return {3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z, -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
          0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z};
}

/// wavelengthRgb at the whole nanometres, linear in between, and the integrals that follow from it.
class SpectrumTable {
 public:
  static const SpectrumTable& get() {
    static const SpectrumTable table;
    return table;
  }

  vec3 rgb(float nm) const {
    const Cell cell = findCell(nm);
    return glm::mix(vec3(nodes_[cell.index]), vec3(nodes_[cell.index + 1]), cell.offset);
  }

  const Distribution1D& importance() const { return importance_; }

  /// ∫ wavelengthRgb from the lower end of the range to x (nm above it), exact for the piecewise linear table.
  dvec3 integral(double x) const {
    const auto index = std::min(static_cast<std::size_t>(x), std::size_t{kCells - 1});
    const double t = x - static_cast<double>(index);
    return integrals_[index] + nodes_[index] * (t - 0.5 * t * t) + nodes_[index + 1] * (0.5 * t * t);
  }

  struct Cell {
    std::size_t index;
    float offset;
  };
  static Cell findCell(float nm) {
    const float x = std::clamp(nm - kWavelengthMin_nm, 0.0F, static_cast<float>(kCells));
    const auto index = std::min(static_cast<std::size_t>(x), std::size_t{kCells - 1});
    return {index, x - static_cast<float>(index)};
  }

 private:
  using Nodes = std::array<dvec3, kCells + 1>;

  SpectrumTable() : nodes_(makeNodes()), integrals_(integrate(nodes_)), importance_(makeImportance(nodes_)) {}

  static Nodes integrate(const Nodes& nodes) {
    Nodes integrals{};
    for (std::size_t i = 0; i < kCells; ++i) integrals[i + 1] = integrals[i] + 0.5 * (nodes[i] + nodes[i + 1]);
    return integrals;
  }

  static Nodes makeNodes() {
    Nodes nodes{};
    for (std::size_t i = 0; i <= kCells; ++i)
      nodes[i] = toRec709(computeColourMatching(static_cast<double>(kWavelengthMin_nm) + static_cast<double>(i)));
    const dvec3 mean = integrate(nodes)[kCells] / static_cast<double>(kCells);
    for (dvec3& node : nodes) node /= mean;
    return nodes;
  }

  static Distribution1D makeImportance(const Nodes& nodes) {
    std::array<float, kCells> weights{};
    for (std::size_t i = 0; i < kCells; ++i) {
      const dvec3 sum = glm::abs(nodes[i]) + glm::abs(nodes[i + 1]);
      weights[i] = static_cast<float>(sum.x + sum.y + sum.z);
    }
    return Distribution1D(weights);
  }

  Nodes nodes_;
  Nodes integrals_;
  Distribution1D importance_;
};

bool isInRange(float nm) { return nm >= kWavelengthMin_nm && nm <= kWavelengthMax_nm; }

/// nm above the lower end for u, in double: the ends of bands.
double quantile(double u) {
  if (u >= 1.0) return kCells;
  const auto s = SpectrumTable::get().importance().sample(static_cast<float>(u));
  return static_cast<double>(s.index) + static_cast<double>(s.offset);
}

}  // namespace

vec3 colourMatching(float wavelength_nm) { return vec3(computeColourMatching(static_cast<double>(wavelength_nm))); }

vec3 wavelengthRgb(float wavelength_nm) {
  return isInRange(wavelength_nm) ? SpectrumTable::get().rgb(wavelength_nm) : vec3(0);
}

std::vector<Band> makeBands(int count) {
  NEPHROID_ASSERT_GE(count, 1);
  if (count == 1) return {{kWavelengthD_nm, vec3(1)}};
  const SpectrumTable& table = SpectrumTable::get();
  std::vector<Band> bands;
  dvec3 left(1);
  for (int i = 0; i < count; ++i) {
    const double lower = quantile(static_cast<double>(i) / count), upper = quantile((i + 1.0) / count);
    // The middle of the band by importance is where half of its light is on each side.
    const double middle = quantile((i + 0.5) / count);
    // The last band takes what the rounding of the others to float left over.
    const vec3 weight(i + 1 < count ? (table.integral(upper) - table.integral(lower)) / static_cast<double>(kCells)
                                    : left);
    left -= dvec3(weight);
    bands.push_back({kWavelengthMin_nm + static_cast<float>(middle), weight});
  }
  return bands;
}

Band sampleWavelength(float u) {
  const SpectrumTable& table = SpectrumTable::get();
  const auto s = table.importance().sample(u);
  const float nm = kWavelengthMin_nm + static_cast<float>(s.index) + s.offset;
  return {nm, table.rgb(nm) / s.pdf};
}

float pdfWavelength(float wavelength_nm) {
  if (!isInRange(wavelength_nm)) return 0.0F;
  return SpectrumTable::get().importance().probability(SpectrumTable::findCell(wavelength_nm).index);
}

float invertWavelength(float wavelength_nm) {
  const auto cell = SpectrumTable::findCell(wavelength_nm);
  return SpectrumTable::get().importance().invert(cell.index, cell.offset);
}

}  // namespace nephroid

#include "closed_form/forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "closed_form/ball.h"
#include "closed_form/blur.h"
#include "closed_form/drop.h"
#include "closed_form/hollow.h"
#include "closed_form/mirrors.h"
#include "closed_form/optics.h"
#include "closed_form/prism.h"
#include "closed_form/profile.h"
#include "closed_form/ring.h"
#include "closed_form/slab.h"
#include "closed_form/wave.h"
#include "core/spectrum.h"
#include "nephroid/error.h"

namespace nephroid::closed_form {
namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
/// Pixels of a profile along a picture's width; of rings about its middle, half as many pixels are in a radius.
constexpr int kPixels = 512;
/// Facets around balls and rings: their edges' own error is far below the tolerances.
constexpr int kBallSegments = 1024, kRingSegments = 2048, kWaveCells = 512;

double sumOf(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }
double largestOf(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }
double relativeError(double measured, double predicted) { return std::abs(measured / predicted - 1.0); }

std::vector<double> compareClearSlab(const SlabCase& c, const PlaneRenderer& render) {
  PlaneView view = slabView(c);
  view.columns = view.rows = kPixels;
  const PlanePicture picture = render(makeSlabScene(c), view, {});
  const double predicted = slabIrradiance(c).x;
  return {relativeError(meanIrradiance(picture).x, predicted),
          relativeL1(picture.columnMeans(), std::vector<double>(kPixels, predicted))};
}

std::vector<double> compareColouredSlab(const SlabCase& c, const PlaneRenderer& render) {
  const dvec3 measured = meanIrradiance(render(makeSlabScene(c), slabView(c), {})), predicted = slabIrradiance(c);
  return {relativeError(measured.x, predicted.x), relativeError(measured.y, predicted.y),
          relativeError(measured.z, predicted.z)};
}

std::vector<double> compareBall(const BallCase& c, const PlaneRenderer& render) {
  const PlanePicture picture = render(makeBallScene(c, kBallSegments), ballView(c, 2 * kPixels), {});
  const auto error = [&](std::size_t rings) {
    return relativeL1(picture.ringMeans(c.view_radius, rings), ballIrradiance(c, rings));
  };
  return {error(64), error(kPixels)};
}

std::vector<double> compareHollow(const HollowCase& c, const PlaneRenderer& render) {
  // Facets no smaller than the texels of a caustic map's pictures, from which its search over the mesh starts.
  const PlanePicture picture = render(makeHollowScene(c, kBallSegments / 2), ballView(c.ball, 2 * kPixels), {});
  const auto error = [&](std::size_t rings) {
    return relativeL1(picture.ringMeans(c.ball.view_radius, rings), hollowIrradiance(c, rings));
  };
  return {error(64), error(kPixels)};
}

std::vector<double> compareWave(const WaveCase& c, const PlaneRenderer& render) {
  const std::vector<double> measured = render(makeWaveScene(c, kWaveCells), waveView(c), {}).columnMeans();
  const std::vector<double> predicted = waveIrradiance(c, kPixels);
  return {relativeL1(measured, predicted), relativeError(sumOf(measured), sumOf(predicted))};
}

std::vector<double> compareRing(const PlaneRenderer& render) {
  const RingCase c;
  const PlanePicture picture = render(makeRingScene(c, kRingSegments), ringView(c, kPixels), {});
  const Image predicted = ringIrradiance(c, kPixels);
  const double pixel = picture.view.pixelSize() / c.inner_radius;
  return {relativeL1(axisProfile(picture.irradiance, 32), axisProfile(predicted, 32)),
          relativeL1(sumSquares(picture.irradiance), sumSquares(predicted)), nephroidDistance(c, picture),
          std::abs(cuspPosition(c, picture) + 0.5) / pixel};
}

/// The worst of three angles of incidence: of the least deviation, and eight degrees to both sides.
std::vector<double> comparePrism(const PlaneRenderer& render) {
  PrismCase c;
  const double apex = radiansD(c.apex_deg), least_deg = degreesD(prismMinimumDeviation(apex, c.ior));
  double worst = 0.0;
  for (const double off_deg : {-8.0, 0.0, 8.0}) {
    c.incidence_deg = 0.5 * (c.apex_deg + least_deg) + off_deg;
    const double predicted = prismDeviation(apex, radiansD(c.incidence_deg), c.ior);
    const std::vector<double> measured = measureDeviations(c, radiansD(c.sun_elevation_deg) + predicted, render);
    if (measured.size() != 1 || !std::isfinite(measured[0])) return {kNotMeasured};
    worst = std::max(worst, degreesD(std::abs(measured[0] - predicted)));
  }
  return {worst};
}

std::vector<double> comparePrismBands(const PlaneRenderer& render) {
  const PrismCase c = FanCase{}.prism();
  const double apex = radiansD(c.apex_deg),
               expected = radiansD(c.sun_elevation_deg) + prismMinimumDeviation(apex, c.ior);
  const std::vector<double> measured = measureDeviations(c, expected, render, {"bands=3"});
  // Blue is turned most and lands nearest, at the left; bands are in order of wavelength, blue first.
  const std::vector<Band> bands = makeBands(3);
  if (measured.size() != bands.size()) return {kNotMeasured};
  std::vector<double> errors;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    const double ior = cauchyIndex(c.ior, c.abbe, static_cast<double>(bands[i].wavelength_nm));
    errors.push_back(degreesD(std::abs(measured[i] - prismDeviation(apex, radiansD(c.incidence_deg), ior))));
  }
  return {largestOf(errors)};
}

std::vector<double> compareFan(const PlaneRenderer& render) {
  const FanCase c;
  return {relativeColourL1(binColumns(render(c.scene(), c.view(), {}), c.bins), fanIrradiance(c))};
}

std::vector<double> compareDrop(const PlaneRenderer& render) {
  const DropCase c;
  return {largestOf(bowErrors_deg(c, render(makeDropScene(c), dropView(c), {fmt::format("bands={}", kBowBands)})))};
}

std::vector<double> compareParaboloid(const PlaneRenderer& render) {
  const ParaboloidCase c;
  // The window is a fifth of the receiver: what would miss the focus by 2 mm, a 500th of the aperture, would be missed.
  const PlanePicture picture =
      render(makeParaboloidScene(c, 256), receiverView(c.focal_length, 0.2 * c.receiver, 64), {});
  return {relativeError(picture.flux().x, paraboloidFlux(c)), picture.meanRadius() / (c.x1 - c.x0)};
}

std::vector<double> compareSphericalMirror(const PlaneRenderer& render) {
  const SphericalMirrorCase c;
  const PlanePicture picture =
      render(makeSphericalMirrorScene(c, 256, 512), receiverView(c.plane, 2.0 * c.receiver_radius, 2 * kPixels), {});
  return {relativeL1(picture.ringMeans(c.receiver_radius, 64), sphericalIrradiance(c, 64))};
}

std::vector<double> compareCrossings(const PlaneRenderer& render) {
  double worst = 0.0;
  for (const double h : {0.1, 0.3, 0.5})
    worst = std::max(worst, std::abs(measureCrossing(h, render) - sphericalCrossing(1.0, h)));
  return {worst};
}

std::vector<double> compareBlur(const BlurCase& c, const PlaneRenderer& render) {
  const PlanePicture picture = render(makeBlurScene(c), blurView(c), {});
  return {relativeL1(picture.columnMeans(), blurIrradiance(c, kPixels)),
          relativeError(measureEdgeWidth(c, picture).value_or(kNotMeasured), edgeWidth())};
}

template <class Case>
auto with(std::vector<double> (*compare)(const Case&, const PlaneRenderer&), const Case& c) {
  return [compare, c](const PlaneRenderer& render) { return compare(c, render); };
}

ClosedForm makeClearSlab(double angle_deg) {
  return {fmt::format("slab-{}", angle_deg),
          fmt::format("clear slab, light at {}°", angle_deg),
          1 << 21,
          {{"irradiance", Unit::kShare, 0.001, 0.005}, {"profile", Unit::kShare, {}, 0.005}},
          with(compareClearSlab, SlabCase{.angle_deg = angle_deg})};
}

ClosedForm makeColouredSlab(double angle_deg) {
  return {fmt::format("slab-coloured-{}", angle_deg),
          fmt::format("coloured slab, light at {}°", angle_deg),
          1 << 21,
          {{"red", Unit::kShare, 0.01, 0.02}, {"green", Unit::kShare, 0.01, 0.02}, {"blue", Unit::kShare, 0.01, 0.02}},
          with(compareColouredSlab, SlabCase{.angle_deg = angle_deg, .color = dvec3(0.9, 0.5, 0.15)})};
}

/// Of what has rings. @param tolerance  of 64 rings for the reference, of 512 for frames
std::vector<Figure> ringFigures(double reference_tolerance, double realtime_tolerance) {
  return {{"64 rings", Unit::kShare, reference_tolerance, {}}, {"512 rings", Unit::kShare, {}, realtime_tolerance}};
}

ClosedForm makeBall(const char* name, const char* text, const BallCase& c) {
  return {name, text, 1 << 21, ringFigures(0.01, 0.06), with(compareBall, c)};
}

ClosedForm makeHollow(const char* name, const char* text, double inner_radius) {
  return {name, text, 1 << 21, ringFigures(0.02, 0.08),
          with(compareHollow, HollowCase{{.gap = 0.05, .view_radius = 0.1}, inner_radius})};
}

ClosedForm makeWave(const char* name, const char* text, double depth) {
  return {name,
          text,
          1 << 20,
          {{"profile", Unit::kShare, 0.01, 0.08}, {"energy", Unit::kShare, 0.01, 0.02}},
          with(compareWave, WaveCase{.depth = depth})};
}

ClosedForm makeBlur(const char* name, const char* text, double ior) {
  // Footprints of a sun this large cover the picture, each a hundred thousand pixels: more of them would take minutes.
  return {name,
          text,
          1 << 20,
          {{"profile", Unit::kShare, 0.02, {}}, {"width", Unit::kShare, 0.02, {}}},
          with(compareBlur, BlurCase{.ior = ior})};
}

std::vector<ClosedForm> makeForms() {
  return {
      makeClearSlab(0),
      makeClearSlab(30),
      makeClearSlab(60),
      makeColouredSlab(0),
      makeColouredSlab(45),
      makeWave("wave-shallow", "sinusoidal water, above its focus", 0.5),
      makeWave("wave-deep", "sinusoidal water, beyond its first fold", 2.0),
      makeBall("ball-before", "ball, just behind it: before its focus", {.gap = 0.015, .view_radius = 0.03}),
      makeBall("ball-behind", "ball, behind its focus", {.gap = 0.05, .view_radius = 0.1}),
      makeHollow("hollow-thick", "hollow ball, cavity of half its radius", 0.025),
      makeHollow("hollow-thin", "hollow ball, cavity of nine tenths", 0.045),
      {"ring",
       "the nephroid in a mirror ring",
       1 << 22,
       {{"axis", Unit::kShare, 0.02, 0.08},
        {"floor", Unit::kShare, 0.02, {}},
        {"curve", Unit::kPixels, 1.5, {}},
        {"cusp", Unit::kPixels, 1.5, {}}},
       compareRing},
      {"prism", "prism, about the least deviation", 1 << 17, {{"deviation", Unit::kDegrees, 0.05, 0.2}}, comparePrism},
      {"prism-bands",
       "dispersive prism, three bands",
       1 << 18,
       {{"deviation", Unit::kDegrees, 0.05, 0.2}},
       comparePrismBands},
      {"prism-white", "dispersive prism, white light", 1 << 22, {{"fan", Unit::kShare, 0.03, {}}}, compareFan},
      {"drop", "rainbow of a drop of water", 1 << 22, {{"bow", Unit::kDegrees, 0.05, {}}}, compareDrop},
      {"paraboloid",
       "parabolic mirror",
       1 << 18,
       {{"flux", Unit::kShare, 0.002, {}}, {"spot", Unit::kShare, 1e-4, {}}},
       compareParaboloid},
      {"mirror",
       "spherical mirror, aberration disc",
       1 << 20,
       {{"64 rings", Unit::kShare, 0.02, {}}},
       compareSphericalMirror},
      {"mirror-axis",
       "spherical mirror, where rays cross the axis",
       1 << 16,
       {{"crossing", Unit::kShare, 1e-3, {}}},
       compareCrossings},
      makeBlur("blur-air", "shadow's edge under a sun of 6°, air", 1.0),
      makeBlur("blur-water", "shadow's edge under a sun of 6°, water", 1.33),
  };
}

}  // namespace

std::span<const ClosedForm> closedForms() {
  static const std::vector<ClosedForm> kForms = makeForms();
  return kForms;
}

const ClosedForm& findClosedForm(std::string_view name) {
  std::vector<std::string> names;
  for (const ClosedForm& form : closedForms()) {
    if (form.name == name) return form;
    names.push_back(form.name);
  }
  throw UsageError(fmt::format("no closed form '{}'; there are: {}", name, fmt::join(names, ", ")));
}

std::vector<std::optional<double>> measureErrors(const ClosedForm& form, const PlaneRenderer& render) {
  bool any_light = false;
  const std::vector<double> values =
      form.compare([&](const SceneData& scene, const PlaneView& view, const std::vector<std::string>& parameters) {
        PlanePicture picture = render(scene, view, parameters);
        any_light = any_light || !picture.isBlack();
        return picture;
      });
  std::vector<std::optional<double>> errors;
  for (const double value : values)
    errors.push_back(any_light && std::isfinite(value) ? std::optional(value) : std::nullopt);
  return errors;
}

std::optional<double> toleranceFor(const Figure& figure, const Technique& technique) {
  return technique.make_realtime != nullptr ? figure.realtime_tolerance : figure.reference_tolerance;
}

}  // namespace nephroid::closed_form

#include "closed_form/forms.h"

#include <gtest/gtest.h>

#include <set>

#include "closed_form/optics.h"
#include "closed_form/slab.h"

namespace nephroid::closed_form {
namespace {

/// A floor that is lit evenly, as under a slab, whatever the scene is.
PlaneRenderer paintEvenly(const dvec3& irradiance) {
  return [irradiance](const SceneData&, const PlaneView& view, const std::vector<std::string>&) {
    PlanePicture picture{view, Image(view.columns, view.rows, 3), {}, {}};
    for (int y = 0; y < view.rows; ++y)
      for (int x = 0; x < view.columns; ++x) picture.irradiance.setRgb(x, y, vec3(irradiance));
    return picture;
  };
}

TEST(Forms, FindNoErrorInThePredictedPictureAndWhatWasPutIntoAnother) {
  const dvec3 predicted = slabIrradiance({.angle_deg = 45.0, .color = dvec3(0.9, 0.5, 0.15)});
  const ClosedForm& form = findClosedForm("slab-coloured-45");
  for (const std::optional<double>& error : measureErrors(form, paintEvenly(predicted))) {
    ASSERT_TRUE(error);
    EXPECT_LT(*error, 1e-6);  // of floats
  }
  const std::vector<std::optional<double>> errors =
      measureErrors(form, paintEvenly(predicted * dvec3(1.02, 0.97, 1.0)));
  ASSERT_EQ(errors.size(), 3U);
  EXPECT_NEAR(errors[0].value_or(0.0), 0.02, 1e-6);
  EXPECT_NEAR(errors[1].value_or(0.0), 0.03, 1e-6);
  EXPECT_NEAR(errors[2].value_or(1.0), 0.0, 1e-6);
}

TEST(Forms, HaveNothingToSayOfBlackPictures) {
  for (const char* name : {"slab-0", "prism", "mirror-axis", "blur-air"})
    for (const std::optional<double>& error : measureErrors(findClosedForm(name), paintEvenly(dvec3(0.0))))
      EXPECT_FALSE(error) << name;
}

TEST(Forms, AreNamedOnceAndSayHowExactTheReferenceHasToBe) {
  std::set<std::string> names;
  for (const ClosedForm& form : closedForms()) {
    EXPECT_TRUE(names.insert(form.name).second) << form.name;
    bool has_tolerance = false;
    for (const Figure& figure : form.figures) has_tolerance |= figure.reference_tolerance.has_value();
    EXPECT_TRUE(has_tolerance) << form.name;
  }
}

TEST(PlanePicture, TakesMeansOverRowsColumnsAndRings) {
  // Light in one pixel of 4 x 2, of 8 W/m².
  PlanePicture picture;
  picture.view.columns = 4, picture.view.rows = 2, picture.view.width = 4.0;
  picture.irradiance = Image(4, 2, 3);
  EXPECT_TRUE(picture.isBlack());
  picture.irradiance.setRgb(3, 1, vec3(8.0F));
  EXPECT_FALSE(picture.isBlack());
  EXPECT_EQ(picture.columnMeans(), (std::vector<double>{0, 0, 0, 4}));
  EXPECT_EQ(picture.rowMeans(), (std::vector<double>{0, 2}));
  EXPECT_EQ(picture.flux().x, 8.0);
  // Its centre is at (1.5, 0.5), √2.5 = 1.58 from the middle: in the outer of two rings, one of four pixels there.
  EXPECT_EQ(picture.ringMeans(2.0, 2), (std::vector<double>{0, 2}));
  EXPECT_NEAR(picture.meanRadius(), std::sqrt(2.5), 1e-12);
}

TEST(PlanePicture, SharesPixelsAmongWideRings) {
  // A pixel from (7, 3) to (8, 4) about the middle, across the circle of radius 8 between two rings.
  PlanePicture picture;
  picture.view.columns = picture.view.rows = 32, picture.view.width = 32.0;
  picture.irradiance = Image(32, 32, 3);
  picture.irradiance.setRgb(16 + 7, 16 + 3, vec3(1.0F));
  const std::vector<double> means = picture.ringMeans(16.0, 2);
  // ∫ √(64 − y²) − 7 dy from 3 to 4.
  const double inside = 0.1911;
  EXPECT_NEAR(means[0] * kPiD * 64.0, inside, 0.02);
  EXPECT_NEAR(means[1] * kPiD * 192.0, 1.0 - inside, 0.02);
}

}  // namespace
}  // namespace nephroid::closed_form

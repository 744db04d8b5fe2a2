#include "metrics/line_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/metrics/metric_pictures.h"

namespace {

using namespace tests;
using metrics::find_transition;
using metrics::ImageLine;
using metrics::line_profile;

Image gray_of(int width_px, int height_px, const std::function<double(double x, double y)>& value) {
  Image image = perception::make_gray_image(width_px, height_px, "Y", Encoding::scene_linear);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) image.at(x, y) = static_cast<float>(value(x, y));
  }
  return image;
}

/// A profile from a function of the distance, every quarter of a pixel.
std::vector<metrics::ProfileSample> profile_of(double length_px,
                                               const std::function<double(double)>& value) {
  std::vector<metrics::ProfileSample> profile;
  for (double s = 0.0; s <= length_px; s += 0.25) profile.push_back({s, value(s)});
  return profile;
}

/// 0 up to begin, 1 from end, linear between.
double ramp(double s, double begin, double end) {
  return std::clamp((s - begin) / (end - begin), 0.0, 1.0);
}

TEST(LineProfile, OfAPlaneIsItsValueEverywhere) {
  const Image plane = gray_of(40, 30, [](double x, double y) { return 0.02 * x + 0.03 * y; });
  const auto line = metrics::line_in_pixels({0.2, 0.3, 0.8, 0.6}, plane);
  EXPECT_NEAR(line.length_px, std::hypot(24.0, 9.0), 1e-12);
  const auto profile = line_profile(plane, nullptr, line, 5);
  EXPECT_EQ(profile.size(), static_cast<std::size_t>(std::ceil(4.0 * line.length_px)) + 1);
  for (const auto& sample : profile) {
    const double x = 7.5 + sample.distance_px * line.along_x;
    const double y = 8.5 + sample.distance_px * line.along_y;
    EXPECT_NEAR(sample.value, 0.02 * x + 0.03 * y, 1e-6);
  }
}

TEST(LineProfile, TheStripIsAcrossTheLine) {
  // Bright rows beside a dark one: a strip of three along the row sees a mean of two thirds.
  const Image rows = gray_of(16, 9, [](double, double y) { return y == 4.0 ? 0.0 : 1.0; });
  const auto line = metrics::line_in_pixels({}, rows);
  EXPECT_NEAR(line_profile(rows, nullptr, line, 1)[20].value, 0.0, 1e-12);
  EXPECT_NEAR(line_profile(rows, nullptr, line, 3)[20].value, 2.0 / 3.0, 1e-12);
}

TEST(LineProfile, PixelsOutsideTheMaskHaveNoSay) {
  Image image = gray_of(16, 3, [](double, double) { return 0.25; });
  image.at(7, 1) = 100.0F;
  const Image others = mask_where(16, 3, [](int x, int y) { return x != 7 || y != 1; });
  const auto line = metrics::line_in_pixels({}, image);
  for (const auto& sample : line_profile(image, &others, line, 3)) {
    EXPECT_NEAR(sample.value, 0.25, 1e-12);
  }
  // The strip of one pixel has no value at that pixel's centre.
  EXPECT_EQ(line_profile(image, &others, line, 1).size(), 16U * 4U);
}

TEST(LineProfile, FindsTheTransitionOfARamp) {
  const auto found = find_transition(
      profile_of(100.0, [](double s) { return 3.0 - 2.0 * ramp(s, 33.3, 58.3); }), 100.0);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->width_px(), 20.0, 1e-9);
  EXPECT_NEAR(found->middle_px(), 45.8, 1e-9);
  EXPECT_NEAR(found->start_level, 3.0, 1e-12);
  EXPECT_NEAR(found->end_level, 1.0, 1e-12);
}

TEST(LineProfile, TheShortestWayCountsNotTheLongest) {
  // Up, half back, and up again without falling to 10 %: one transition; back to 0: only the last.
  const auto twice = [](double valley) {
    return profile_of(100.0, [valley](double s) {
      if (s < 40.0) return ramp(s, 20.0, 30.0);
      if (s < 60.0) return 1.0 - (1.0 - valley) * ramp(s, 40.0, 50.0);
      return valley + (1.0 - valley) * ramp(s, 60.0, 65.0);
    });
  };
  EXPECT_NEAR(find_transition(twice(0.5), 100.0)->width_px(), 8.0, 1e-9);
  EXPECT_NEAR(find_transition(twice(0.0), 100.0)->width_px(), 4.0, 1e-9);
}

TEST(LineProfile, WithoutAStepThereIsNoTransition) {
  const auto step_of = [](double step) {
    return profile_of(100.0, [step](double s) { return 1.0 - step * ramp(s, 40.0, 60.0); });
  };
  EXPECT_FALSE(find_transition(step_of(0.0), 100.0).has_value());
  EXPECT_FALSE(find_transition(step_of(0.009), 100.0).has_value());
  EXPECT_TRUE(find_transition(step_of(0.011), 100.0).has_value());
  EXPECT_FALSE(find_transition(profile_of(100.0, [](double) { return 0.0; }), 100.0).has_value());
  // An end that the mask has cut off shows no level.
  auto cut = step_of(0.5);
  cut.erase(cut.begin(), cut.begin() + 50);
  EXPECT_FALSE(find_transition(cut, 100.0).has_value());
}

}  // namespace

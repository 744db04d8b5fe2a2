#include "metrics/metric_input.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "perception/color_conversion.h"

namespace metrics {
namespace {

TEST(MetricInput, DecodesEveryDisplayValueAsPerceptionDoes) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  // All values of 8 bits, what lies close to them, and what no 8 bits hold.
  std::vector<float> values{-1.0F, -0.001F, 1.001F, 2.5F, 1e30F, kInfinity, -kInfinity};
  for (int i = 0; i < 256; ++i) {
    const float value = static_cast<float>(i) / 255.0F;
    values.insert(values.end(), {value, std::nextafter(value, 2.0F), std::nextafter(value, -1.0F),
                                 value + 0.3F / 255.0F, value * 0.9371F});
  }
  while (values.size() % 3 != 0) values.push_back(0.5F);
  perception::Image image(static_cast<int>(values.size() / 3), 1, {"R", "G", "B"},
                          perception::Encoding::display);
  image.pixels = values;
  const InputImage linear = linear_input(image, "mse");
  const perception::Image expected = perception::srgb_decoded(image);
  EXPECT_EQ(linear.image().encoding, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(linear.image().pixels[i], expected.pixels[i]) << values[i];
  }
}

TEST(MetricInput, ADisplayValueThatIsNoNumberStaysNone) {
  perception::Image image(1, 1, {"R", "G", "B"}, perception::Encoding::display);
  image.pixels[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(linear_input(image, "mse").image().pixels[1]));
}

}  // namespace
}  // namespace metrics

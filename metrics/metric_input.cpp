#include "metrics/metric_input.h"

#include <array>

#include <fmt/format.h>

#include "metrics/separable_filter.h"
#include "perception/base/errors.h"
#include "perception/color_conversion.h"
#include "perception/display_model.h"

namespace metrics {
namespace {

bool is_rgb(const Image& image) {
  return image.channel_count() == 3 && image.channels[0] == "R" && image.channels[1] == "G" &&
         image.channels[2] == "B";
}

/// sRGB decoded, each value of 8 bits once: pictures are mostly of those.
Image decoded(const Image& display) {
  constexpr float kMost = 255.0F;
  std::array<float, 256> encoded{};
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < encoded.size(); ++i) {
    encoded[i] = static_cast<float>(i) / kMost;
    linear[i] = perception::srgb_decode(encoded[i]);
  }
  Image result = perception::rgb_of(display);
  result.encoding = perception::Encoding::scene_linear;
  for_each_row(result.height_px, [&](int y) {
    const std::size_t end = result.offset(0, y) + 3 * static_cast<std::size_t>(result.width_px);
    for (std::size_t i = result.offset(0, y); i < end; ++i) {
      float& value = result.pixels[i];
      const bool is_inside = value >= 0.0F && value <= 1.0F;
      const auto step = static_cast<std::size_t>(is_inside ? value * kMost + 0.5F : 0.0F);
      value = encoded[step] == value ? linear[step] : perception::srgb_decode(value);
    }
  });
  return result;
}

}  // namespace

void require_relative_light(const Image& image, std::string_view metric) {
  if (image.encoding != perception::Encoding::luminance_cd_m2) return;
  throw base::InputError(fmt::format(
      "metric \"{}\" takes images with encoding scene_linear or display, not luminance_cd_m2",
      metric));
}

InputImage rgb_input(const Image& image) {
  return is_rgb(image) ? InputImage(image) : InputImage(perception::rgb_of(image));
}

InputImage linear_input(const Image& image, std::string_view metric) {
  require_relative_light(image, metric);
  if (image.encoding == perception::Encoding::scene_linear) return rgb_input(image);
  return InputImage(decoded(image));
}

Image linear_luminance(const Image& image, std::string_view metric) {
  const InputImage linear = linear_input(image, metric);
  Image luminance = perception::make_gray_image(image.width_px, image.height_px, "Y",
                                                perception::Encoding::scene_linear);
  for_each_pixel(luminance, [&](std::size_t i) {
    const float* rgb = &linear.image().pixels[3 * i];
    const auto& weights = perception::kRec709Luma;
    luminance.pixels[i] = weights[0] * rgb[0] + weights[1] * rgb[1] + weights[2] * rgb[2];
  });
  return luminance;
}

InputImage display_input(const Image& image, const ViewingConditions& viewing,
                         std::string_view metric) {
  require_relative_light(image, metric);
  if (image.encoding == perception::Encoding::display) return rgb_input(image);
  return InputImage(perception::to_display_encoded(rgb_input(image).image(), viewing.exposure_ev));
}

InputImage light_input(const Image& image, const ViewingConditions& viewing) {
  if (image.encoding == perception::Encoding::luminance_cd_m2) return rgb_input(image);
  return InputImage(perception::to_display_light(rgb_input(image).image(), viewing));
}

}  // namespace metrics

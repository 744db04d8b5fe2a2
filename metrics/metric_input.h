#pragma once

#include <optional>
#include <string_view>
#include <utility>

#include "metrics/metric.h"

namespace metrics {

/// An image a metric works on: the caller's own if it fits as it is, else a converted copy.
class InputImage {
 public:
  /// @param borrowed  must outlive this object
  explicit InputImage(const Image& borrowed) : borrowed_(&borrowed) {}
  explicit InputImage(Image&& converted) : converted_(std::move(converted)) {}

  const Image& image() const { return borrowed_ != nullptr ? *borrowed_ : *converted_; }

 private:
  const Image* borrowed_ = nullptr;
  std::optional<Image> converted_;
};

/// R, G, B of an image, encoding unchanged. @throws base::InputError as perception::rgb_of
InputImage rgb_input(const Image& image);

/// Scene-linear R, G, B; a display-encoded image is decoded (IEC 61966-2-1).
/// @param metric  name for the message
/// @throws base::InputError for absolute light, which has another scale
InputImage linear_input(const Image& image, std::string_view metric);

/// Scene-linear luminance, one channel (weights of ITU-R BT.709), negative where the image is.
/// @throws base::InputError as linear_input
Image linear_luminance(const Image& image, std::string_view metric);

/// sRGB-encoded R, G, B in [0, 1]: scene-linear values times 2^exposure_ev, clamped, encoded.
/// @throws base::InputError for absolute light
InputImage display_input(const Image& image, const ViewingConditions& viewing,
                         std::string_view metric);

/// The light that leaves the display, linear Rec.709 R, G, B in cd/m2; absolute light as it is.
/// @throws base::InputError as perception::to_display_light
InputImage light_input(const Image& image, const ViewingConditions& viewing);

/// @throws base::InputError unless the image is scene-linear or display-encoded
void require_relative_light(const Image& image, std::string_view metric);

}  // namespace metrics

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "perception/false_color.h"
#include "perception/opencv_view.h"

namespace perception {
namespace {

constexpr int kMargin_px = 10;
constexpr int kBarHeight_px = 14;
constexpr int kTick_px = 4;
constexpr int kLegendHeight_px = 50;
constexpr int kLeastWidth_px = 320;
constexpr int kTicks = 5;
constexpr double kFontScale = 0.38;
const cv::Scalar kWhite(1.0, 1.0, 1.0);

/// Value at a position of the scale; inverse of `scale_position`.
double value_at(double position, const MapScale& scale) {
  if (!scale.is_logarithmic) return scale.low + position * (scale.high - scale.low);
  return scale.low * std::pow(scale.high / scale.low, position);
}

/// Positions of the ticks: powers of ten on a logarithmic scale, else evenly spaced.
std::vector<double> tick_positions(const MapScale& scale) {
  std::vector<double> positions;
  if (scale.is_logarithmic) {
    const int first = static_cast<int>(std::ceil(std::log10(scale.low) - 1e-9));
    const int last = static_cast<int>(std::floor(std::log10(scale.high) + 1e-9));
    for (int power = first; power <= last; ++power) {
      positions.push_back(scale_position(std::pow(10.0, power), scale));
    }
    return positions;
  }
  for (int i = 0; i < kTicks; ++i) positions.push_back(static_cast<double>(i) / (kTicks - 1));
  return positions;
}

void put_text(cv::Mat& picture, const std::string& text, int center_px, int baseline_px) {
  int below_px = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kFontScale, 1, &below_px);
  const int left_px =
      std::clamp(center_px - size.width / 2, 0, std::max(0, picture.cols - size.width));
  cv::putText(picture, text, {left_px, baseline_px}, cv::FONT_HERSHEY_SIMPLEX, kFontScale, kWhite,
              1, cv::LINE_AA);
}

}  // namespace

Image false_color_picture(const Image& map, const MapScale& scale) {
  const int width_px = std::max(map.width_px, kLeastWidth_px);
  Image picture = make_rgb_image(width_px, map.height_px + kLegendHeight_px, Encoding::display);
  const Image colors = false_color_image(map, scale);
  for (int y = 0; y < map.height_px; ++y) {
    std::copy_n(&colors.pixels[colors.offset(0, y)], 3 * static_cast<std::size_t>(map.width_px),
                &picture.pixels[picture.offset(0, y)]);
  }

  const int bar_px = width_px - 2 * kMargin_px;
  const int top_px = map.height_px + kMargin_px / 2;
  for (int x = 0; x < bar_px; ++x) {
    const std::array<float, 3> color = false_color((x + 0.5) / bar_px);
    for (int y = 0; y < kBarHeight_px; ++y) {
      std::copy(color.begin(), color.end(),
                &picture.pixels[picture.offset(kMargin_px + x, top_px + y)]);
    }
  }
  cv::Mat view = opencv_view(picture);
  const int below_px = top_px + kBarHeight_px;
  for (const double position : tick_positions(scale)) {
    const int x = kMargin_px + static_cast<int>(std::lround(position * (bar_px - 1)));
    cv::line(view, {x, below_px}, {x, below_px + kTick_px}, kWhite);
    put_text(view, fmt::format("{:.3g}", value_at(position, scale)), x, below_px + 15);
  }
  put_text(view, scale.unit, width_px / 2, below_px + 28);
  return picture;
}

}  // namespace perception

#include "metrics/flip_ldr.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "metrics/vector_math.h"
#include "perception/color_conversion.h"

namespace metrics {
namespace {

/// Colour error is raised to this power (Sec. 4.1.3).
constexpr float kColorPower = 0.7F;
/// The share kSplitInput of the largest colour error is mapped to kSplitOutput (Sec. 4.1.3).
constexpr float kSplitInput = 0.4F;
constexpr float kSplitOutput = 0.95F;

using Color = std::array<float, 3>;
using Matrix = std::array<Color, 3>;

/// Linear RGB to CIE XYZ and back, and the XYZ of white.
struct ColorSpaces {
  Matrix xyz_of_rgb;
  Matrix rgb_of_xyz;
  Color white;
  Color inverse_white;
};

ColorSpaces color_spaces() {
  ColorSpaces spaces{};
  for (std::size_t column = 0; column < 3; ++column) {
    Color unit{};
    unit[column] = 1.0F;
    const Color xyz = perception::xyz_from_linear_rgb(unit);
    const Color rgb = perception::linear_rgb_from_xyz(unit);
    for (std::size_t row = 0; row < 3; ++row) {
      spaces.xyz_of_rgb[row][column] = xyz[row];
      spaces.rgb_of_xyz[row][column] = rgb[row];
    }
  }
  spaces.white = perception::xyz_from_linear_rgb({1.0F, 1.0F, 1.0F});
  for (std::size_t i = 0; i < 3; ++i) spaces.inverse_white[i] = 1.0F / spaces.white[i];
  return spaces;
}

Color product(const Matrix& m, const Color& v) {
  return {m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2],
          m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2],
          m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2]};
}

Color scaled(const Color& color, const Color& factors) {
  return {color[0] * factors[0], color[1] * factors[1], color[2] * factors[2]};
}

/// Linear RGB to the opponent space YCxCz, in which linear filters act (Sec. 4.1.1).
Color to_ycxcz(const ColorSpaces& spaces, const Color& rgb) {
  const Color xyz = scaled(product(spaces.xyz_of_rgb, rgb), spaces.inverse_white);
  return {116.0F * xyz[1] - 16.0F, 500.0F * (xyz[0] - xyz[1]), 200.0F * (xyz[1] - xyz[2])};
}

Color from_ycxcz(const ColorSpaces& spaces, const Color& ycxcz) {
  const float y = (ycxcz[0] + 16.0F) / 116.0F;
  const float x = y + ycxcz[1] / 500.0F;
  const float z = y - ycxcz[2] / 200.0F;
  return product(spaces.rgb_of_xyz, scaled({x, y, z}, spaces.white));
}

float in_unit_range(float x) {
  const float positive = x < 0.0F ? 0.0F : x;
  return positive > 1.0F ? 1.0F : positive;
}

/// The nonlinearity of CIE L*a*b* (CIE 15, delta = 6 / 29).
float lab_curve(float t) {
  constexpr float kDelta = 6.0F / 29.0F;
  constexpr float kDelta3 = kDelta * kDelta * kDelta;
  const float root = cube_root(t < kDelta3 ? kDelta3 : t);
  const float line = t * (1.0F / (3.0F * kDelta * kDelta)) + 4.0F / 29.0F;
  return t > kDelta3 ? root : line;
}

/// L*, and a*, b* times 0.01 L* (Hunt effect, Sec. 4.1.2).
struct HuntLab {
  float lightness, green_red, blue_yellow;
};

/// Rows of X, Y, Z over those of white become rows of L*, a*, b* with the Hunt effect, in loops
/// short enough to be vectorised. This and the row functions below are compiled twice, as
/// weighted_sum is (separable_filter.cpp); their values do not depend on which one runs.
[[gnu::target_clones("avx2", "default")]] void to_hunt_lab(const RowOfThree& row, int width_px) {
  float* __restrict x = row.first;
  float* __restrict y = row.second;
  float* __restrict z = row.third;
  for (float* values : {x, y, z}) {
    for (int i = 0; i < width_px; ++i) values[i] = lab_curve(values[i]);
  }
  for (int i = 0; i < width_px; ++i) {
    const float fx = x[i];
    const float fy = y[i];
    const float fz = z[i];
    const float lightness = 116.0F * fy - 16.0F;
    const float hunt = 0.01F * lightness;
    x[i] = lightness;
    y[i] = hunt * (500.0F * (fx - fy));
    z[i] = hunt * (200.0F * (fy - fz));
  }
}

/// HyAB distance (Sec. 4.1.3).
float hyab(const HuntLab& p, const HuntLab& q) {
  const float a = p.green_red - q.green_red;
  const float b = p.blue_yellow - q.blue_yellow;
  return std::abs(p.lightness - q.lightness) + std::sqrt(a * a + b * b);
}

/// The largest colour error, between pure green and pure blue (Sec. 4.1.3): 41.276.
float largest_color_error() {
  const ColorSpaces spaces = color_spaces();
  const Color green = scaled(product(spaces.xyz_of_rgb, {0.0F, 1.0F, 0.0F}), spaces.inverse_white);
  const Color blue = scaled(product(spaces.xyz_of_rgb, {0.0F, 0.0F, 1.0F}), spaces.inverse_white);
  std::array<float, 2> first{green[0], blue[0]};
  std::array<float, 2> second{green[1], blue[1]};
  std::array<float, 2> third{green[2], blue[2]};
  to_hunt_lab({first.data(), second.data(), third.data()}, 2);
  const float distance = hyab({first[0], second[0], third[0]}, {first[1], second[1], third[1]});
  return std::pow(distance, kColorPower);
}

/// Rows of the filtered opponent channels to X, Y, Z over white of what the display can show.
[[gnu::target_clones("avx2", "default")]] void to_relative_xyz(const float* ycc, const float* cx,
                                                               const float* cz, int width_px,
                                                               const RowOfThree& out) {
  const ColorSpaces spaces = color_spaces();
  float* __restrict x = out.first;
  float* __restrict y = out.second;
  float* __restrict z = out.third;
  for (int i = 0; i < width_px; ++i) {
    const Color rgb = from_ycxcz(spaces, {ycc[i], cx[i], cz[i]});
    const Color shown{in_unit_range(rgb[0]), in_unit_range(rgb[1]), in_unit_range(rgb[2])};
    const Color xyz = scaled(product(spaces.xyz_of_rgb, shown), spaces.inverse_white);
    x[i] = xyz[0];
    y[i] = xyz[1];
    z[i] = xyz[2];
  }
}

/// A row of linear RGB to the opponent channels, in place.
[[gnu::target_clones("avx2", "default")]] void to_ycxcz_row(const RowOfThree& row, int width_px) {
  const ColorSpaces spaces = color_spaces();
  float* __restrict red = row.first;
  float* __restrict green = row.second;
  float* __restrict blue = row.third;
  for (int i = 0; i < width_px; ++i) {
    const Color ycxcz = to_ycxcz(spaces, {red[i], green[i], blue[i]});
    red[i] = ycxcz[0];
    green[i] = ycxcz[1];
    blue[i] = ycxcz[2];
  }
}

[[gnu::target_clones("avx2", "default")]] void norm_of(const std::vector<float>& x,
                                                       const std::vector<float>& y, float* out) {
  for (std::size_t i = 0; i < x.size(); ++i) out[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
}

/// Colour difference mapped to [0, 1] (Sec. 4.1.3).
float color_difference(float distance, float largest) {
  const float bounded = distance < 1e-30F ? 1e-30F : distance;
  const float error = power_of(bounded, kColorPower);
  const float split = kSplitInput * largest;
  const float low = error * (kSplitOutput / split);
  const float high = kSplitOutput + (error - split) * ((1.0F - kSplitOutput) / (largest - split));
  return error < split ? low : high;
}

/// A row of what is seen.
struct SeenRow {
  const float *lightness, *green_red, *blue_yellow, *edge, *point;
};

/// Raises a row of the map to the difference of two rows (Sec. 4.3).
[[gnu::target_clones("avx2", "default")]] void raise_row(const SeenRow& r, const SeenRow& t,
                                                         int width_px, float* __restrict out) {
  const float largest = largest_color_error();
  constexpr float kSqrtHalf = 1.0F / std::numbers::sqrt2_v<float>;
  for (int i = 0; i < width_px; ++i) {
    const float distance = hyab({r.lightness[i], r.green_red[i], r.blue_yellow[i]},
                                {t.lightness[i], t.green_red[i], t.blue_yellow[i]});
    const float color = color_difference(distance, largest);
    const float edge = std::abs(r.edge[i] - t.edge[i]);
    const float point = std::abs(r.point[i] - t.point[i]);
    const float feature = std::sqrt(kSqrtHalf * (edge > point ? edge : point));
    const float power = power_of(color, 1.0F - feature);
    const float difference = distance > 0.0F ? in_unit_range(power) : 0.0F;
    out[i] = difference > out[i] ? difference : out[i];
  }
}

}  // namespace

SeenPicture::SeenPicture(int width_px, int height_px)
    : lightness(width_px, height_px),
      green_red(width_px, height_px),
      blue_yellow(width_px, height_px),
      edge(width_px, height_px),
      point(width_px, height_px) {}

FlipObserver::FlipObserver(int width_px, int height_px, const FlipFilters& filters)
    : filters_(filters) {
  for (Plane<float>* plane :
       {&along_.achromatic, &along_.red_green, &along_.blue_yellow_wide, &along_.blue_yellow_narrow,
        &along_.gaussian, &along_.edge, &along_.point}) {
    *plane = Plane<float>(width_px, height_px);
  }
}

void FlipObserver::look(const PictureRows& picture, SeenPicture& seen) {
  const int height_px = along_.achromatic.height_px;
  for_each_row(height_px, [&](int y) { filter_along_row(y, picture); });
  for_each_row(height_px, [&](int y) { filter_across_rows_to(y, seen); });
}

void FlipObserver::filter_along_row(int y, const PictureRows& picture) {
  const int width_px = along_.achromatic.width_px;
  const int pad_px = filters_.largest_radius_px();
  PaddedRow<float> achromatic(width_px, pad_px);
  PaddedRow<float> red_green(width_px, pad_px);
  PaddedRow<float> blue_yellow(width_px, pad_px);
  PaddedRow<float> features(width_px, pad_px);
  const RowOfThree row{achromatic.data(), red_green.data(), blue_yellow.data()};
  picture(y, row);
  to_ycxcz_row(row, width_px);
  // Features are found on the achromatic channel in [0, 1] (Sec. 4.2).
  for (int i = 0; i < width_px; ++i) {
    features.data()[i] = achromatic.data()[i] * (1.0F / 116.0F) + 16.0F / 116.0F;
  }
  achromatic.repeat_ends();
  red_green.repeat_ends();
  blue_yellow.repeat_ends();
  features.repeat_ends();

  achromatic.filter(filters_.achromatic, along_.achromatic.row(y));
  red_green.filter(filters_.red_green, along_.red_green.row(y));
  blue_yellow.filter(filters_.blue_yellow_wide, along_.blue_yellow_wide.row(y));
  blue_yellow.filter(filters_.blue_yellow_narrow, along_.blue_yellow_narrow.row(y));
  features.filter(filters_.gaussian, along_.gaussian.row(y));
  features.filter(filters_.edge, along_.edge.row(y));
  features.filter(filters_.point, along_.point.row(y));
}

void FlipObserver::filter_across_rows_to(int y, SeenPicture& seen) const {
  const int width_px = along_.achromatic.width_px;
  std::vector<float> first(static_cast<std::size_t>(width_px));
  std::vector<float> second(first.size());
  std::vector<float> third(first.size());
  std::vector<float> fourth(first.size());

  // Contrast sensitivity: the blue-yellow channel is the sum of two Gaussians.
  filter_across_rows(along_.achromatic, y, filters_.achromatic, first.data());
  filter_across_rows(along_.red_green, y, filters_.red_green, second.data());
  filter_across_rows(along_.blue_yellow_wide, y, filters_.blue_yellow_wide, third.data());
  filter_across_rows(along_.blue_yellow_narrow, y, filters_.blue_yellow_narrow, fourth.data());
  for (std::size_t i = 0; i < third.size(); ++i) third[i] += fourth[i];
  const RowOfThree lab{seen.lightness.row(y), seen.green_red.row(y), seen.blue_yellow.row(y)};
  to_relative_xyz(first.data(), second.data(), third.data(), width_px, lab);
  to_hunt_lab(lab, width_px);

  // Features: derivative along one axis, Gaussian along the other.
  filter_across_rows(along_.edge, y, filters_.gaussian, first.data());
  filter_across_rows(along_.gaussian, y, filters_.edge, second.data());
  norm_of(first, second, seen.edge.row(y));
  filter_across_rows(along_.point, y, filters_.gaussian, first.data());
  filter_across_rows(along_.gaussian, y, filters_.point, second.data());
  norm_of(first, second, seen.point.row(y));
}

void raise_to_flip_difference(const SeenPicture& reference, const SeenPicture& test,
                              Plane<float>& map) {
  for_each_row(map.height_px, [&](int y) {
    raise_row({reference.lightness.row(y), reference.green_red.row(y), reference.blue_yellow.row(y),
               reference.edge.row(y), reference.point.row(y)},
              {test.lightness.row(y), test.green_red.row(y), test.blue_yellow.row(y),
               test.edge.row(y), test.point.row(y)},
              map.width_px, map.row(y));
  });
}

}  // namespace metrics

// Burt, Adelson 1983, "The Laplacian Pyramid as a Compact Image Code",
// doi:10.1109/TCOM.1983.1095851: the generating kernel (a = 0.4), REDUCE, EXPAND.

#include "perception/image_pyramid.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "perception/base/parallel.h"

namespace perception {
namespace {

/// Rows of one piece of parallel work; fixed, so that it never depends on the thread count.
constexpr std::size_t kGrainRows = 16;

void make_like(const Image& model, Image& image) {
  if (image.has_size_of(model) && image.channel_count() == 1) return;
  image = make_gray_image(model.width_px, model.height_px, model.channels.front(), model.encoding);
}

int inside(int i, int count, Border border) {
  if (border == Border::yee_mirror) {
    if (i < 0) i = -i;
    if (i >= count) i = 2 * count - i - 1;
  }
  return std::clamp(i, 0, count - 1);
}

/// The kernel in differences from the centre, which are exactly 0 where nothing changes; sums of
/// two, so that left and right play the same part.
inline float filtered(float centre, float l1, float r1, float l2, float r2,
                      const FiveTapKernel& k) {
  return centre +
         (k.inner * ((l1 - centre) + (r1 - centre)) + k.outer * ((l2 - centre) + (r2 - centre)));
}

void smooth_row(const float* in, int width, const FiveTapKernel& k, Border border, float* out) {
  const int s = k.spacing_px;
  const auto at = [&](int x) { return in[inside(x, width, border)]; };
  const auto slow = [&](int x) {
    out[x] = filtered(in[x], at(x - s), at(x + s), at(x - 2 * s), at(x + 2 * s), k);
  };
  const int first = std::min(2 * s, width);
  const int last = std::max(width - 2 * s, first);
  for (int x = 0; x < first; ++x) slow(x);
  for (int x = first; x < last; ++x) {
    out[x] = filtered(in[x], in[x - s], in[x + s], in[x - 2 * s], in[x + 2 * s], k);
  }
  for (int x = last; x < width; ++x) slow(x);
}

void smooth_column_row(const Image& in, int y, const FiveTapKernel& k, Border border, float* out) {
  const int s = k.spacing_px;
  const auto row = [&](int i) {
    return in.pixels.data() + in.offset(0, inside(i, in.height_px, border));
  };
  const float* centre = row(y);
  const float* l1 = row(y - s);
  const float* r1 = row(y + s);
  const float* l2 = row(y - 2 * s);
  const float* r2 = row(y + 2 * s);
  for (int x = 0; x < in.width_px; ++x) {
    out[x] = filtered(centre[x], l1[x], r1[x], l2[x], r2[x], k);
  }
}

/// Calls body(y) for every row of the image, in parallel.
template <class Body>
void for_rows(int height_px, const Body& body) {
  base::parallel_for(static_cast<std::size_t>(height_px), kGrainRows,
                     [&](std::size_t y, std::size_t end) {
                       for (; y < end; ++y) body(static_cast<int>(y));
                     });
}

/// Response of the Burt-Adelson kernel with a = 0.4: 0.4 + 0.5 cos(2 pi f) + 0.1 cos(4 pi f).
double kernel_response(double cycles_px) {
  const double phase = 2.0 * std::numbers::pi * cycles_px;
  return 0.4 + 0.5 * std::cos(phase) + 0.1 * std::cos(2.0 * phase);
}

int step_spacing_px(LowPassStack::Kind kind, int level) {
  return kind == LowPassStack::Kind::octaves ? 1 << level : 1;
}

/// Two passes of (p, 1 - 2 p, p), joined: variance 4 p spacing^2; p at most 1/4, so that no weight
/// is negative.
FiveTapKernel kernel_of_variance(double variance_px2) {
  const int spacing_px = std::max(1, static_cast<int>(std::ceil(std::sqrt(variance_px2))));
  const double p = variance_px2 / (4.0 * spacing_px * spacing_px);
  return {spacing_px, static_cast<float>(p * p), static_cast<float>(2.0 * p * (1.0 - 2.0 * p))};
}

Image decimated(const Image& image) {
  Image half = make_gray_image((image.width_px + 1) / 2, (image.height_px + 1) / 2,
                               image.channels.front(), image.encoding);
  for_rows(half.height_px, [&](int y) {
    for (int x = 0; x < half.width_px; ++x) half.at(x, y) = image.at(2 * x, 2 * y);
  });
  return half;
}

/// EXPAND along one axis: 2 (0.05, 0.4, 0.05) at even places, 2 (0.25, 0.25) at odd ones.
template <class At>
float expanded_value(int i, int count, const At& at) {
  const int k = i / 2;
  const int next = std::min(k + 1, count - 1);
  if (i % 2 == 1) return 0.5F * (at(std::min(k, count - 1)) + at(next));
  const float centre = at(std::min(k, count - 1));
  return centre + 0.1F * ((at(std::max(k - 1, 0)) - centre) + (at(next) - centre));
}

/// The best of frequencies spaced by 0.2 %.
double searched_peak(LowPassStack::Kind kind, int band) {
  constexpr int kSteps = 4096;
  double best = 0.5;
  double best_response = 0.0;
  for (int step = 0; step <= kSteps; ++step) {
    const double f = 0.5 * std::exp2(-12.0 * step / kSteps);
    double response = 1.0 - kernel_response(step_spacing_px(kind, band) * f);
    for (int i = 0; i < band; ++i) response *= kernel_response(step_spacing_px(kind, i) * f);
    if (response <= best_response) continue;
    best = f;
    best_response = response;
  }
  return best;
}

}  // namespace

double FiveTapKernel::variance_px2() const {
  const double s2 = static_cast<double>(spacing_px) * static_cast<double>(spacing_px);
  return 2.0 * s2 * (static_cast<double>(inner) + 4.0 * static_cast<double>(outer));
}

FiveTapKernel burt_adelson_kernel(int spacing_px) { return {spacing_px, 0.05F, 0.25F}; }

void smooth(const Image& image, const FiveTapKernel& kernel, Border border, Image& scratch,
            Image& result) {
  assert(image.channel_count() == 1 && kernel.spacing_px > 0);
  assert(&image != &scratch && &image != &result && &scratch != &result);
  make_like(image, scratch);
  make_like(image, result);
  for_rows(image.height_px, [&](int y) {
    smooth_row(image.pixels.data() + image.offset(0, y), image.width_px, kernel, border,
               scratch.pixels.data() + scratch.offset(0, y));
  });
  for_rows(image.height_px, [&](int y) {
    smooth_column_row(scratch, y, kernel, border, result.pixels.data() + result.offset(0, y));
  });
}

bool is_last_level_below(const LowPassStack& stack, double sigma_px) {
  const double next_px2 =
      stack.variance_px2() + burt_adelson_kernel(1 << stack.level()).variance_px2();
  return next_px2 > sigma_px * sigma_px;
}

Image gaussian_average(const LowPassStack& stack, double sigma_px) {
  const double left_px2 = sigma_px * sigma_px - stack.variance_px2();
  if (left_px2 <= 0.0) return stack.current();
  Image scratch;
  Image result;
  smooth(stack.current(), kernel_of_variance(left_px2), Border::replicate, scratch, result);
  return result;
}

Image gaussian_average(const Image& image, double sigma_px) {
  assert(sigma_px >= 0.0);
  LowPassStack stack(image, LowPassStack::Kind::octaves);
  while (!is_last_level_below(stack, sigma_px)) stack.advance();
  return gaussian_average(stack, sigma_px);
}

Image reduce(const Image& image) {
  Image scratch;
  Image smoothed;
  smooth(image, burt_adelson_kernel(1), Border::replicate, scratch, smoothed);
  return decimated(smoothed);
}

Image expand(const Image& image, int width_px, int height_px) {
  assert((width_px + 1) / 2 == image.width_px && (height_px + 1) / 2 == image.height_px);
  Image wide = make_gray_image(width_px, image.height_px, image.channels.front(), image.encoding);
  for_rows(wide.height_px, [&](int y) {
    for (int x = 0; x < width_px; ++x) {
      wide.at(x, y) = expanded_value(x, image.width_px, [&](int k) { return image.at(k, y); });
    }
  });
  Image result = make_gray_image(width_px, height_px, image.channels.front(), image.encoding);
  for_rows(height_px, [&](int y) {
    for (int x = 0; x < width_px; ++x) {
      result.at(x, y) = expanded_value(y, image.height_px, [&](int k) { return wide.at(x, k); });
    }
  });
  return result;
}

LaplacianPyramid laplacian_pyramid(const Image& image, int bands) {
  LaplacianPyramid pyramid;
  pyramid.base = image;
  for (int i = 0; i < bands; ++i) {
    if (std::min(pyramid.base.width_px, pyramid.base.height_px) < 2) break;
    Image coarser = reduce(pyramid.base);
    const Image back = expand(coarser, pyramid.base.width_px, pyramid.base.height_px);
    for (std::size_t p = 0; p < back.pixels.size(); ++p) pyramid.base.pixels[p] -= back.pixels[p];
    pyramid.bands.push_back(std::move(pyramid.base));
    pyramid.base = std::move(coarser);
  }
  return pyramid;
}

Image reconstructed(const LaplacianPyramid& pyramid) {
  Image image = pyramid.base;
  for (auto band = pyramid.bands.rbegin(); band != pyramid.bands.rend(); ++band) {
    image = expand(image, band->width_px, band->height_px);
    for (std::size_t p = 0; p < image.pixels.size(); ++p) image.pixels[p] += band->pixels[p];
  }
  return image;
}

LowPassStack::LowPassStack(const Image& image, Kind kind) : kind_(kind), kept_(3) {
  assert(image.channel_count() == 1);
  kept_[0] = image;
}

void LowPassStack::advance() {
  const FiveTapKernel kernel = burt_adelson_kernel(step_spacing_px(kind_, level_));
  const Border border = kind_ == Kind::octaves ? Border::replicate : Border::yee_mirror;
  // The oldest image's memory takes the new level.
  std::rotate(kept_.begin(), kept_.end() - 1, kept_.end());
  smooth(kept_[1], kernel, border, scratch_, kept_[0]);
  variance_px2_ += kernel.variance_px2();
  ++level_;
}

double band_peak_cycles_px(LowPassStack::Kind kind, int band) {
  using Kind = LowPassStack::Kind;
  constexpr int kTabulated = 12;  // as many as masking settings may ask for
  using Peaks = std::array<double, kTabulated>;
  static const auto kPeaks = [] {
    std::array<Peaks, 2> peaks;
    for (const Kind each : {Kind::octaves, Kind::repeated_kernel}) {
      for (int i = 0; i < kTabulated; ++i) {
        peaks[static_cast<std::size_t>(each)][static_cast<std::size_t>(i)] = searched_peak(each, i);
      }
    }
    return peaks;
  }();
  if (band >= kTabulated) return searched_peak(kind, band);
  return kPeaks[static_cast<std::size_t>(kind)][static_cast<std::size_t>(band)];
}

}  // namespace perception

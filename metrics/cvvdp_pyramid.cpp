#include "metrics/cvvdp_pyramid.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace metrics {
namespace {

// The kernel's weights by distance from its centre.
constexpr float kCentre = 0.4F;
constexpr float kNear = 0.25F;
constexpr float kFar = 0.05F;

/// Measured peaks of the bands below the finest, as a share of the Nyquist frequency at their own
/// level's double size.
constexpr double kBandPeak = 0.3228;
/// No band is made below the first one that is not above this.
constexpr double kLowestBand_cpd = 0.2;
/// Frequency at which the base band is judged.
constexpr double kBaseBand_cpd = 0.1;

/// Index mirrored at both ends, the end itself taken twice.
int mirrored(int i, int count) {
  if (i < 0) return -i - 1;
  return i < count ? i : 2 * count - 1 - i;
}

/// Keeps every second value of a filtered row.
void reduce_row(const std::vector<float>& row, bool has_odd_rows, int count, float* out) {
  const auto width = static_cast<int>(row.size());
  const float* v = row.data();
  out[0] = kCentre * v[0] + kNear * (v[0] + v[1]) + kFar * (v[1] + v[2]);
  for (int x = 1; x < count - 1; ++x) {
    const float* c = v + 2 * x;
    out[x] = kCentre * c[0] + kNear * (c[-1] + c[1]) + kFar * (c[-2] + c[2]);
  }
  const int last = 2 * (count - 1);
  float sum = kCentre * v[last] + kNear * v[last - 1] + kFar * v[last - 2];
  if (last + 1 < width) sum += kNear * v[last + 1];
  sum += has_odd_rows ? kNear * v[width - 1] + kFar * v[width - 2] : kFar * v[width - 1];
  out[count - 1] = sum;
}

}  // namespace

std::vector<double> cvvdp_band_frequencies_cpd(int width_px, int height_px,
                                               double pixels_per_degree) {
  const auto side = static_cast<unsigned>(std::min(width_px, height_px));
  const int most_reductions = std::max(static_cast<int>(std::bit_width(side)) - 2, 0);
  std::vector<double> frequencies{0.5 * pixels_per_degree};
  double next = kBandPeak * 0.5 * pixels_per_degree;
  while (frequencies.back() > kLowestBand_cpd) {
    frequencies.push_back(next);
    next *= 0.5;
  }
  if (static_cast<int>(frequencies.size()) > most_reductions) {
    frequencies.resize(static_cast<std::size_t>(most_reductions));
  }
  frequencies.push_back(kBaseBand_cpd);
  return frequencies;
}

Plane<float> cvvdp_reduced(const Plane<float>& fine) {
  assert(fine.width_px >= 4 && fine.height_px >= 4);
  Plane<float> coarse((fine.width_px + 1) / 2, (fine.height_px + 1) / 2);
  const bool has_odd_rows = fine.height_px % 2 == 1;
  for_each_row(coarse.height_px, [&](int y) {
    const auto row_at = [&](int offset) {
      return fine.row(mirrored(2 * y + offset, fine.height_px));
    };
    const float *a = row_at(-2), *b = row_at(-1), *c = row_at(0), *d = row_at(1), *e = row_at(2);
    std::vector<float> filtered(static_cast<std::size_t>(fine.width_px));
    float* __restrict out = filtered.data();
    for (int x = 0; x < fine.width_px; ++x) {
      out[x] = kCentre * c[x] + kNear * (b[x] + d[x]) + kFar * (a[x] + e[x]);
    }
    reduce_row(filtered, has_odd_rows, coarse.width_px, coarse.row(y));
  });
  return coarse;
}

void cvvdp_expand_row(const Plane<float>& coarse, int y, int fine_width_px, float* out) {
  // Between the inserted zeros, even places meet three weights and odd ones two; all are doubled.
  const int k = y / 2;
  const float* here = coarse.row(k);
  const float* below = coarse.row(std::min(k + 1, coarse.height_px - 1));
  const int width = coarse.width_px;
  PaddedRow<float> row(width, 1);
  float* __restrict v = row.data();
  if (y % 2 == 1) {
    for (int x = 0; x < width; ++x) v[x] = 2.0F * kNear * (here[x] + below[x]);
  } else {
    const float* above = coarse.row(std::max(k - 1, 0));
    for (int x = 0; x < width; ++x) {
      v[x] = 2.0F * kCentre * here[x] + 2.0F * kFar * (above[x] + below[x]);
    }
  }
  row.repeat_ends();
  const int pairs = fine_width_px / 2;
  for (int x = 0; x < pairs; ++x) {
    out[2 * x] = 2.0F * kCentre * v[x] + 2.0F * kFar * (v[x - 1] + v[x + 1]);
    out[2 * x + 1] = 2.0F * kNear * (v[x] + v[x + 1]);
  }
  if (fine_width_px % 2 == 1) {
    out[2 * pairs] = 2.0F * kCentre * v[pairs] + 2.0F * kFar * (v[pairs - 1] + v[pairs + 1]);
  }
}

}  // namespace metrics

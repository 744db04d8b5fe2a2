#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "perception/base/parallel.h"
#include "perception/image.h"

namespace metrics {

/// A channel on its own: row-major values, top-left first.
template <typename Value>
struct Plane {
  Plane() = default;
  /// Zero-filled.
  Plane(int width, int height)
      : width_px(width),
        height_px(height),
        values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  int width_px = 0;
  int height_px = 0;
  std::vector<Value> values;

  Value* row(int y) { return values.data() + offset(y); }
  const Value* row(int y) const { return values.data() + offset(y); }

 private:
  std::size_t offset(int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px);
  }
};

/// Rows that one piece of a parallel loop over an image works on.
inline constexpr std::size_t kRowsPerPiece = 8;

/// Calls body(y) for every row, in parallel; rows must not depend on each other.
template <typename Body>
void for_each_row(int height_px, const Body& body) {
  base::parallel_for(static_cast<std::size_t>(height_px), kRowsPerPiece,
                     [&](std::size_t begin, std::size_t end) {
                       for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
                     });
}

/// Calls body(i) for every pixel, in parallel.
template <typename Body>
void for_each_pixel(const perception::Image& image, const Body& body) {
  for_each_row(image.height_px, [&](int y) {
    const std::size_t begin = image.offset(0, y);
    const std::size_t end = begin + static_cast<std::size_t>(image.width_px);
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// A one-dimensional filter of odd length, centred.
template <typename Value>
struct Kernel {
  std::vector<Value> weights;
  int radius() const { return static_cast<int>(weights.size() / 2); }
};

/// out[x] = sum over k of weights[k] * inputs[k][x], added in the order of k: the inner loop of
/// both passes, along a row (inputs one pixel apart) and across rows (inputs one row apart). Wider
/// instructions are used where the processor has them; every sum is the same without them.
void weighted_sum(std::span<const float> weights, std::span<const float* const> inputs,
                  std::size_t count, float* out);
void weighted_sum(std::span<const double> weights, std::span<const double* const> inputs,
                  std::size_t count, double* out);

/// A row with its first and last value repeated on both sides.
template <typename Value>
class PaddedRow {
 public:
  PaddedRow(int width_px, int pad_px)
      : width_px_(width_px),
        pad_px_(pad_px),
        values_(static_cast<std::size_t>(width_px + 2 * pad_px)) {}

  /// The row itself, to be filled before `repeat_ends` or `mirror_ends`.
  Value* data() { return values_.data() + pad_px_; }
  void repeat_ends() {
    std::fill_n(values_.begin(), pad_px_, data()[0]);
    std::fill_n(values_.end() - pad_px_, pad_px_, data()[width_px_ - 1]);
  }

  /// Mirrors the row at the centres of its first and last value. @pre width > pad
  void mirror_ends() {
    for (int i = 1; i <= pad_px_; ++i) {
      data()[-i] = data()[i];
      data()[width_px_ - 1 + i] = data()[width_px_ - 1 - i];
    }
  }

  /// The filtered row. @param kernel  of radius <= pad
  void filter(const Kernel<Value>& kernel, Value* out) const {
    std::vector<const Value*> inputs(kernel.weights.size());
    const Value* first = values_.data() + pad_px_ - kernel.radius();
    for (std::size_t k = 0; k < inputs.size(); ++k) inputs[k] = first + k;
    weighted_sum(kernel.weights, inputs, static_cast<std::size_t>(width_px_), out);
  }

 private:
  int width_px_;
  int pad_px_;
  std::vector<Value> values_;
};

/// Row y of a plane filtered across rows; rows beyond the border repeat the first or last one.
template <typename Value>
void filter_across_rows(const Plane<Value>& plane, int y, const Kernel<Value>& kernel, Value* out) {
  std::vector<const Value*> inputs(kernel.weights.size());
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const int row = y + static_cast<int>(k) - kernel.radius();
    inputs[k] = plane.row(std::clamp(row, 0, plane.height_px - 1));
  }
  weighted_sum(kernel.weights, inputs, static_cast<std::size_t>(plane.width_px), out);
}

}  // namespace metrics

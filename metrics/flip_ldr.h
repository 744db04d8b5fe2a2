#pragma once

#include <functional>

#include "metrics/flip_filters.h"
#include "metrics/separable_filter.h"

/// FLIP of two pictures of low dynamic range.
///
/// Source: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, FLIP: A
/// Difference Evaluator for Alternating Images, Proc. ACM Comput. Graph. Interact. Tech. 3(2),
/// article 15, doi:10.1145/3406183. Section numbers, here and in flip_filters, are recalled from
/// memory; the formulas were checked against the authors' program, version 1.6.
namespace metrics {

/// A row of three channels: red, green, blue, or what is computed from them in their place.
struct RowOfThree {
  float* first;
  float* second;
  float* third;
};

/// Delivers row y of a picture: linear Rec.709 in [0, 1]. Called from several threads.
using PictureRows = std::function<void(int y, const RowOfThree& out)>;

/// What the observer takes in of one picture (Sec. 4.1.2 and 4.2).
struct SeenPicture {
  SeenPicture(int width_px, int height_px);

  Plane<float> lightness;    ///< CIE L* of the picture blurred by the eye, [0, 100]
  Plane<float> green_red;    ///< a*, times 0.01 L* (Hunt effect)
  Plane<float> blue_yellow;  ///< b*, times 0.01 L*
  Plane<float> edge;         ///< norm of the first derivative of the achromatic channel
  Plane<float> point;        ///< norm of the second derivative
};

/// An observer at a given number of pixels per degree; keeps its buffers from picture to picture.
class FlipObserver {
 public:
  FlipObserver(int width_px, int height_px, const FlipFilters& filters);

  /// Looks at a picture of the observer's size.
  void look(const PictureRows& picture, SeenPicture& seen);

 private:
  void filter_along_row(int y, const PictureRows& picture);
  void filter_across_rows_to(int y, SeenPicture& seen) const;

  FlipFilters filters_;
  /// Rows filtered along x only.
  struct {
    Plane<float> achromatic, red_green, blue_yellow_wide, blue_yellow_narrow;
    Plane<float> gaussian, edge, point;
  } along_;
};

/// Raises each pixel of a map to the FLIP difference in [0, 1] of what was seen (Sec. 4.3) where
/// that is larger.
/// @param map  of the pictures' size; 0 before the first exposure
void raise_to_flip_difference(const SeenPicture& reference, const SeenPicture& test,
                              Plane<float>& map);

}  // namespace metrics

#pragma once

#include <cstddef>
#include <string>

#include "perception/image.h"

namespace results::html_report {

/// The floats of an image as the page carries them.
///
/// Every value v is kept as the half-float nearest to v x 2^-exponent, where the exponent takes the
/// largest finite value into [2^14, 2^15): nothing finite overflows, and what is 2^29 times smaller
/// keeps its 11 bits. NaN and infinities stay what they are.
struct FloatPayload {
  int width_px = 0;
  int height_px = 0;
  int channels = 0;  ///< 3 (R, G, B) or 1
  int exponent = 0;
  std::size_t non_finite = 0;  ///< pixels with a NaN or infinite channel
  /// zlib stream of, channel by channel: the high bytes of all values, then their low bytes, where
  /// the bits of each value are less those of its left neighbour (of the first in a row: less 0),
  /// modulo 2^16.
  std::string deflated;
};

/// @param image  with R, G and B, or of one channel
/// @throws base::InputError for others
FloatPayload float_payload(const perception::Image& image);

}  // namespace results::html_report

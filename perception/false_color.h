#pragma once

#include <array>
#include <string>

#include "perception/image.h"

namespace perception {

/// A fixed scale for a map: the same value has the same colour in every picture.
struct MapScale {
  double low = 0.0;
  double high = 1.0;
  bool is_logarithmic = false;  ///< low > 0
  std::string unit;             ///< "" if none
};

/// Colour of a position in [0, 1] (clamped), sRGB-encoded; perceptually ordered and readable for
/// colour-blind viewers (the magma family of maps, computed from a table).
std::array<float, 3> false_color(double position);

/// Position of a value on a scale, in [0, 1]; NaN stays NaN.
double scale_position(double value, const MapScale& scale);

/// A one-channel map as a picture (encoding display); non-finite pixels become cyan.
Image false_color_image(const Image& map, const MapScale& scale);

/// The same with the scale below it: a bar of the colours with ticks and numbers in the map's unit.
/// @return encoding display, taller than the map, and wider where the bar needs room
Image false_color_picture(const Image& map, const MapScale& scale);

}  // namespace perception

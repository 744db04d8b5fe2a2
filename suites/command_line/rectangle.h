#pragma once

#include <string_view>

#include "perception/base/errors.h"
#include "perception/base/units.h"

namespace suites::command_line {

/// A part of an image, pixels from the top left.
struct RectanglePx {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

struct PointPx {
  int x = 0;
  int y = 0;
};

/// Reads "x,y,w,h". @param size  the rectangle must lie within an image of this size
/// @throws base::InputError with the accepted form or the image's size
RectanglePx parse_rectangle(std::string_view text, base::SizePx size, const base::Place& place);

/// Reads "x,y"; the point must lie within an image of this size.
PointPx parse_point(std::string_view text, base::SizePx size, const base::Place& place);

}  // namespace suites::command_line

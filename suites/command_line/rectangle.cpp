#include "suites/command_line/rectangle.h"

#include <charconv>
#include <vector>

#include <fmt/format.h>

namespace suites::command_line {

namespace {

/// The whole numbers between commas.
std::vector<int> comma_numbers(std::string_view text, std::size_t count, std::string_view form,
                               const base::Place& place) {
  std::vector<int> numbers;
  const char* cursor = text.data();
  const char* const end = cursor + text.size();
  while (numbers.size() < count) {
    int number = 0;
    const auto [rest, error] = std::from_chars(cursor, end, number);
    if (error != std::errc{}) break;
    numbers.push_back(number);
    cursor = rest;
    if (numbers.size() < count && (cursor == end || *cursor != ',')) break;
    if (numbers.size() < count) ++cursor;
  }
  if (numbers.size() != count || cursor != end) {
    throw base::InputError(
        place, fmt::format("\"{}\" is not {} in whole pixels from the top left", text, form));
  }
  return numbers;
}

}  // namespace

RectanglePx parse_rectangle(std::string_view text, base::SizePx size, const base::Place& place) {
  const std::vector<int> n = comma_numbers(text, 4, "x,y,width,height", place);
  const RectanglePx rectangle{n[0], n[1], n[2], n[3]};
  const bool is_inside = rectangle.x >= 0 && rectangle.y >= 0 && rectangle.width > 0 &&
                         rectangle.height > 0 && rectangle.width <= size.width - rectangle.x &&
                         rectangle.height <= size.height - rectangle.y;
  if (!is_inside) {
    throw base::InputError(place, fmt::format("the rectangle {} is empty or leaves the image of "
                                              "{}x{} pixels",
                                              text, size.width, size.height));
  }
  return rectangle;
}

PointPx parse_point(std::string_view text, base::SizePx size, const base::Place& place) {
  const std::vector<int> n = comma_numbers(text, 2, "x,y", place);
  if (n[0] < 0 || n[1] < 0 || n[0] >= size.width || n[1] >= size.height) {
    throw base::InputError(place, fmt::format("the pixel {} is outside the image of {}x{} pixels",
                                              text, size.width, size.height));
  }
  return {n[0], n[1]};
}

}  // namespace suites::command_line

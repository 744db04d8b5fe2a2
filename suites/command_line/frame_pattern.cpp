#include "suites/command_line/frame_pattern.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

namespace suites::command_line {

namespace {

constexpr int kMostDigits = 9;
constexpr int kDigitsOfASingleHash = 4;
/// A longer sequence is a slip of the pen.
constexpr int kMostFrames = 100000;

/// A place for a frame number in a file name.
struct NumberPlace {
  std::size_t begin = 0;
  std::size_t end = 0;
  int digits = 0;
};

/// "%d" or "%04d" at `begin`; nothing if it is none.
std::optional<NumberPlace> printf_place(std::string_view text, std::size_t begin) {
  std::size_t end = begin + 1;
  int digits = 0;
  while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) {
    digits = 10 * digits + (text[end++] - '0');
    if (digits > kMostDigits) return std::nullopt;
  }
  // "%4d" would fill up with blanks.
  const bool has_zeros = end == begin + 1 || text[begin + 1] == '0';
  if (end == text.size() || text[end] != 'd' || !has_zeros) return std::nullopt;
  return NumberPlace{begin, end + 1, digits};
}

std::vector<NumberPlace> number_places(std::string_view text) {
  std::vector<NumberPlace> places;
  for (std::size_t i = 0; i < text.size();) {
    std::optional<NumberPlace> place;
    if (text[i] == '%') place = printf_place(text, i);
    if (text[i] == '#') {
      const std::size_t end = std::min(text.find_first_not_of('#', i), text.size());
      const int count = static_cast<int>(end - i);
      place = NumberPlace{i, end, count == 1 ? kDigitsOfASingleHash : count};
    }
    if (place) places.push_back(*place);
    i = place ? place->end : i + 1;
  }
  return places;
}

/// The whole number that the text begins with, which is taken off it.
std::optional<int> take_number(std::string_view& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || value < 0 || text.front() == '-') return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

bool take_word(std::string_view& text, std::string_view word) {
  if (text.substr(0, word.size()) != word) return false;
  text.remove_prefix(word.size());
  return true;
}

struct FrameNumbers {
  int first = 0;
  int last = 0;
  int step = 1;
};

std::optional<FrameNumbers> read_frames(std::string_view text) {
  FrameNumbers frames;
  const std::optional<int> first = take_number(text);
  if (!first) return std::nullopt;
  frames.first = frames.last = *first;
  if (text.empty()) return frames;
  if (!take_word(text, "..") && !take_word(text, "-")) return std::nullopt;
  const std::optional<int> last = take_number(text);
  if (!last || *last < *first) return std::nullopt;
  frames.last = *last;
  if (take_word(text, "x")) {
    const std::optional<int> step = take_number(text);
    if (!step || *step < 1) return std::nullopt;
    frames.step = *step;
  }
  return text.empty() ? std::optional(frames) : std::nullopt;
}

}  // namespace

bool has_frame_number(std::string_view text) { return !number_places(text).empty(); }

FramePattern::FramePattern(std::string_view text, const base::Place& place) : text_(text) {
  const std::vector<NumberPlace> places = number_places(text);
  if (places.size() != 1) {
    throw base::InputError(
        place,
        fmt::format("\"{}\" has {} places for the frame number; accepted with --frames: one, "
                    "written %d, %04d or ####",
                    text, places.empty() ? "no" : std::to_string(places.size())));
  }
  before_ = text.substr(0, places.front().begin);
  after_ = text.substr(places.front().end);
  digits_ = places.front().digits;
}

std::string FramePattern::file(int frame) const {
  return fmt::format("{}{:0{}}{}", before_, frame, digits_, after_);
}

std::vector<int> parse_frames(std::string_view text, const base::Place& place) {
  const std::optional<FrameNumbers> frames = read_frames(text);
  if (!frames) {
    throw base::InputError(place,
                           fmt::format("\"{}\" are no frames; accepted: FIRST..LAST such as 0..59, "
                                       "0..58x2 for every second one",
                                       text));
  }
  const std::int64_t count =
      (static_cast<std::int64_t>(frames->last) - frames->first) / frames->step + 1;
  if (count > kMostFrames) {
    throw base::InputError(
        place, fmt::format("\"{}\" are {} frames; accepted: at most {}", text, count, kMostFrames));
  }
  std::vector<int> numbers;
  for (int i = 0; i < count; ++i) numbers.push_back(frames->first + i * frames->step);
  return numbers;
}

}  // namespace suites::command_line

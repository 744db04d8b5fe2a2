#include "renderers/scene/obj_check.h"

#include "perception/base/errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

namespace renderers::scene {
namespace {

/// The whitespace-separated words of a line.
std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kSpace = " \t\r";
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(kSpace); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kSpace, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kSpace, end);
  }
  return words;
}

class ObjCheck {
 public:
  ObjCheck(std::string_view data, const std::string& file) : data_(data), place_{file, 0, 0} {}

  MeshFileCounts run() {
    count_vertices();
    is_used_.resize(static_cast<std::size_t>(vertices_), false);
    for_each_line([this](const std::vector<std::string_view>& words) { check_line(words); });
    if (triangles_ == 0) throw base::InputError(base::Place{place_.file, 0, 0}, "has no faces");
    const auto unused = std::ranges::count(is_used_, false);
    return {triangles_, static_cast<std::size_t>(unused)};
  }

 private:
  template <typename Body>
  void for_each_line(Body&& body) {
    place_.line = 0;
    for (std::size_t begin = 0; begin < data_.size();) {
      const std::size_t end = std::min(data_.find('\n', begin), data_.size());
      ++place_.line;
      const auto words = words_of(data_.substr(begin, end - begin));
      if (!words.empty()) body(words);
      begin = end + 1;
    }
  }

  /// Faces may name vertices that come later, so the count is needed first.
  void count_vertices() {
    for_each_line([this](const std::vector<std::string_view>& words) {
      if (words[0] == "v") ++vertices_;
    });
  }

  void check_line(const std::vector<std::string_view>& words) {
    if (words[0] == "v") {
      ++seen_vertices_;
      check_numbers(words, 3);
    } else if (words[0] == "vn") {
      check_numbers(words, 3);
    } else if (words[0] == "f") {
      check_face(words);
    }
  }

  void check_numbers(const std::vector<std::string_view>& words, std::size_t at_least) const {
    if (words.size() <= at_least) {
      fail(fmt::format("\"{}\" has {} numbers; at least {}", words[0], words.size() - 1, at_least));
    }
    for (std::size_t i = 1; i < words.size(); ++i) {
      double value = 0.0;
      const char* end = words[i].data() + words[i].size();
      const auto result = std::from_chars(words[i].data(), end, value);
      if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value)) {
        fail(fmt::format("\"{}\" is not a finite number", words[i]));
      }
    }
  }

  void check_face(const std::vector<std::string_view>& words) {
    if (words.size() < 4) {
      fail(fmt::format("a face has {} corners; at least 3", words.size() - 1));
    }
    for (std::size_t i = 1; i < words.size(); ++i) is_used_[vertex_of(words[i])] = true;
    triangles_ += words.size() - 3;
  }

  /// Number from 0 of the vertex that a face corner names.
  std::size_t vertex_of(std::string_view corner) const {
    const std::string_view index_text = corner.substr(0, corner.find('/'));
    long long index = 0;
    const char* end = index_text.data() + index_text.size();
    const auto result = std::from_chars(index_text.data(), end, index);
    if (result.ec != std::errc() || result.ptr != end) {
      fail(fmt::format("\"{}\" is not a face corner (v, v/vt, v//vn or v/vt/vn)", corner));
    }
    // Negative indices count back from the vertex read last.
    const bool exists = index > 0 ? index <= vertices_ : index < 0 && -index <= seen_vertices_;
    if (!exists) {
      fail(fmt::format("a face names vertex {}; the file has {}", index, vertices_));
    }
    return static_cast<std::size_t>(index > 0 ? index - 1 : seen_vertices_ + index);
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw base::InputError(place_, message);
  }

  std::string_view data_;
  base::Place place_;
  long long vertices_ = 0;
  long long seen_vertices_ = 0;
  std::vector<bool> is_used_;
  std::size_t triangles_ = 0;
};

}  // namespace

MeshFileCounts check_obj(std::string_view data, const std::string& file) {
  return ObjCheck(data, file).run();
}

}  // namespace renderers::scene

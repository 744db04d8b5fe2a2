#include "renderers/scene/value_reader.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace renderers::scene {
namespace {

float to_float(double value, const base::Node& node, std::string_view what) {
  if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()))) {
    throw base::InputError(node.place(), fmt::format("{} {} is too large", what, value));
  }
  return static_cast<float>(value);
}

}  // namespace

float read_float(const base::Node& node, std::string_view what) {
  return to_float(node.number(what), node, what);
}

float read_positive(const base::Node& node, std::string_view what) {
  const float value = read_float(node, what);
  if (value > 0.0F) return value;
  throw base::InputError(node.place(), fmt::format("{} {} must be greater than 0", what, value));
}

float read_in_range(const base::Node& node, std::string_view what, float low, float high) {
  const float value = read_float(node, what);
  if (value >= low && value <= high) return value;
  throw base::InputError(node.place(),
                         fmt::format("{} {} is outside [{}, {}]", what, value, low, high));
}

glm::vec3 read_vec3(const base::Node& node, std::string_view what) {
  const auto numbers = base::number_list(node, what, 3);
  return {to_float(numbers[0], node, what), to_float(numbers[1], node, what),
          to_float(numbers[2], node, what)};
}

glm::vec3 read_color(const base::Node& node, std::string_view what) {
  const glm::vec3 color =
      node.is_list() ? read_vec3(node, what) : glm::vec3(read_float(node, what));
  for (int i = 0; i < 3; ++i) {
    if (color[i] < 0.0F) {
      throw base::InputError(node.place(),
                             fmt::format("{} {} is negative; give values >= 0", what, color[i]));
    }
  }
  return color;
}

glm::vec3 read_reflectance(const base::Node& node, std::string_view what) {
  const glm::vec3 color =
      node.is_list() ? read_vec3(node, what) : glm::vec3(read_float(node, what));
  for (int i = 0; i < 3; ++i) {
    if (!(color[i] >= 0.0F && color[i] <= 1.0F)) {
      throw base::InputError(node.place(), fmt::format("{} {} is outside [0, 1]", what, color[i]));
    }
  }
  return color;
}

glm::vec3 read_direction(const base::Node& node, std::string_view what) {
  const glm::vec3 direction = read_vec3(node, what);
  const glm::vec3 size = glm::abs(direction);
  const float largest = std::max({size.x, size.y, size.z});
  if (largest == 0.0F) {
    throw base::InputError(node.place(), fmt::format("{} has length 0", what));
  }
  return glm::normalize(direction / largest);
}

int read_count(const base::Node& node, std::string_view what, int low, int high) {
  const std::int64_t value = node.integer(what);
  if (value >= low && value <= high) return static_cast<int>(value);
  throw base::InputError(node.place(),
                         fmt::format("{} {} is outside [{}, {}]", what, value, low, high));
}

}  // namespace renderers::scene

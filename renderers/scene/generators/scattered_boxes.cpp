#include "renderers/scene/generators/scattered_boxes.h"

#include "renderers/scene/generators/uniform_number.h"
#include "renderers/scene/value_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace renderers::scene {
namespace {

constexpr int kMaxBoxes = 100000;

/// Diffuse reflectance of a mid-grey painted surface; ours.
constexpr float kAlbedo = 0.6F;

struct Footprint {
  glm::vec2 center;  ///< x, z
  glm::vec2 axis;    ///< half an edge, x, z
  float ratio;       ///< length of the other half edge over this one
};

/// Top and four sides; the bottom stands on the ground.
void add_box(Mesh& mesh, const Footprint& footprint, float height_m) {
  const glm::vec2 a = footprint.axis;
  const glm::vec2 b = footprint.ratio * glm::vec2(-a.y, a.x);
  const std::array<glm::vec2, 4> corners{footprint.center - a - b, footprint.center - a + b,
                                         footprint.center + a + b, footprint.center + a - b};
  const auto add_face = [&](const std::array<glm::vec3, 4>& face) {
    const auto first = static_cast<unsigned>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), face.begin(), face.end());
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.triangles.emplace_back(first, first + 2, first + 3);
  };
  const auto at = [&](std::size_t i, float y) {
    return glm::vec3(corners[i % 4].x, y, corners[i % 4].y);
  };
  add_face({at(0, height_m), at(1, height_m), at(2, height_m), at(3, height_m)});
  for (std::size_t i = 0; i < 4; ++i) {
    add_face({at(i, 0.0F), at(i + 1, 0.0F), at(i + 1, height_m), at(i, height_m)});
  }
}

std::array<float, 2> read_pair(const base::Node& node, const char* what) {
  const auto numbers = base::number_list(node, what, 2);
  const std::array<float, 2> pair{static_cast<float>(numbers[0]), static_cast<float>(numbers[1])};
  if (!(pair[0] > 0.0F && pair[1] > 0.0F)) {
    throw base::InputError(node.place(), fmt::format("both numbers of {} must be above 0", what));
  }
  return pair;
}

}  // namespace

std::vector<GeneratedPart> scattered_boxes(base::MapReader& reader) {
  std::mt19937_64 engine(static_cast<std::uint64_t>(reader.integer("seed", 1)));
  const int count = read_count(reader.require("count"), "count", 1, kMaxBoxes);
  const auto area = read_pair(reader.require("area"), "area");
  const auto height = read_pair(reader.require("height"), "height");
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
  const int rows = (count + columns - 1) / columns;
  const glm::vec2 cell(area[0] / static_cast<float>(columns), area[1] / static_cast<float>(rows));
  GeneratedPart part;
  part.name = "boxes";
  part.material.albedo = glm::vec3(kAlbedo);
  for (int i = 0; i < count; ++i) {
    const glm::vec2 index(static_cast<float>(i % columns), static_cast<float>(i / columns));
    const float turn_rad = uniform(engine, 0.0F, 2.0F * std::numbers::pi_v<float>);
    const float ratio = uniform(engine, 0.4F, 1.0F);
    // The half diagonal stays below 0.45 of the cell, so that turned neighbours do not touch.
    const float half_edge = uniform(engine, 0.5F, 0.9F) * 0.5F * std::min(cell.x, cell.y) /
                            std::sqrt(1.0F + ratio * ratio);
    const Footprint footprint{(index + 0.5F) * cell - 0.5F * glm::vec2(area[0], area[1]),
                              half_edge * glm::vec2(std::cos(turn_rad), std::sin(turn_rad)), ratio};
    add_box(part.mesh, footprint, uniform(engine, height[0], height[1]));
  }
  return {std::move(part)};
}

}  // namespace renderers::scene

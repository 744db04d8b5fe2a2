#include "renderers/scene/generators/metaballs.h"

#include "renderers/scene/generators/marching_cubes.h"
#include "renderers/scene/generators/uniform_number.h"
#include "renderers/scene/value_reader.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

namespace renderers::scene {
namespace {

constexpr float kLevel = 0.5F;

/// Diffuse reflectance of a mid-grey painted surface; ours.
constexpr float kAlbedo = 0.6F;

constexpr int kMaxBalls = 1000;
constexpr int kLeastResolution = 4;
constexpr int kMaxResolution = 512;
constexpr int kMaxFrames = 100000;

/// Reach of a ball's field over its radius: (1 - 1 / q^2)^3 = kLevel.
float reach_ratio() { return 1.0F / std::sqrt(1.0F - std::cbrt(kLevel)); }

float field_at(const std::vector<Metaballs::Ball>& balls, const glm::vec3& p) {
  float sum = 0.0F;
  for (const Metaballs::Ball& ball : balls) {
    const glm::vec3 to_point = (p - ball.center) / (ball.radius_m * reach_ratio());
    const float rest = 1.0F - glm::dot(to_point, to_point);
    if (rest > 0.0F) sum += rest * rest * rest;
  }
  return sum;
}

/// Against the gradient of the field, out of the balls.
glm::vec3 normal_at(const std::vector<Metaballs::Ball>& balls, const glm::vec3& p) {
  glm::vec3 sum(0.0F);
  for (const Metaballs::Ball& ball : balls) {
    const float reach_m = ball.radius_m * reach_ratio();
    const glm::vec3 to_point = (p - ball.center) / reach_m;
    const float rest = 1.0F - glm::dot(to_point, to_point);
    if (rest > 0.0F) sum += rest * rest / reach_m * to_point;
  }
  const float length = glm::length(sum);
  return length > 0.0F ? sum / length : glm::vec3(0.0F, 1.0F, 0.0F);
}

/// The field on cubes over the box, with a rim of one cube and more where it is below the level.
ScalarGrid sampled(const MetaballSettings& settings, const std::vector<Metaballs::Ball>& balls) {
  ScalarGrid grid;
  const float longest_m = std::max({settings.size_m.x, settings.size_m.y, settings.size_m.z});
  grid.step_m = longest_m / static_cast<float>(settings.resolution);
  // Where balls meet, the surface bulges out of the box, but never beyond the reach of a ball.
  const float rim_m = (reach_ratio() - 1.0F) * settings.greatest_radius_m;
  const glm::vec3 half = 0.5F * settings.size_m + rim_m;
  const glm::ivec3 half_cells = glm::ivec3(glm::ceil(half / grid.step_m)) + 1;
  grid.points = 2 * half_cells + 1;
  grid.origin = -grid.step_m * glm::vec3(half_cells);
  grid.values.resize(static_cast<std::size_t>(grid.points.x) *
                     static_cast<std::size_t>(grid.points.y) *
                     static_cast<std::size_t>(grid.points.z));
  glm::ivec3 p(0);
  for (p.z = 0; p.z < grid.points.z; ++p.z) {
    for (p.y = 0; p.y < grid.points.y; ++p.y) {
      for (p.x = 0; p.x < grid.points.x; ++p.x) {
        grid.values[grid.index(p)] = field_at(balls, grid.origin + grid.step_m * glm::vec3(p));
      }
    }
  }
  return grid;
}

}  // namespace

Metaballs::Metaballs(const MetaballSettings& settings) : settings_(settings) {
  std::mt19937_64 engine(settings.seed);
  for (int i = 0; i < settings.balls; ++i) {
    Path path;
    path.radius_m = uniform(engine, settings.least_radius_m, settings.greatest_radius_m);
    for (int axis = 0; axis < 3; ++axis) {
      const float room_m = 0.5F * settings.size_m[axis] - path.radius_m;
      path.reach[axis] = room_m * uniform(engine, 0.4F, 0.9F);
      path.middle[axis] = (room_m - path.reach[axis]) * uniform(engine, -1.0F, 1.0F);
      path.turns[axis] = uniform(engine, 0.0F, 1.0F) < 0.5F ? 1.0F : 2.0F;
      path.phase[axis] = uniform(engine, 0.0F, 1.0F);
    }
    paths_.push_back(path);
  }
}

std::vector<Metaballs::Ball> Metaballs::balls_at(int frame) const {
  const float time =
      static_cast<float>(std::clamp(frame, 0, last_frame())) / static_cast<float>(settings_.frames);
  std::vector<Ball> balls;
  for (const Path& path : paths_) {
    const glm::vec3 turn = path.turns * time + path.phase;
    Ball ball{path.middle, path.radius_m};
    for (int axis = 0; axis < 3; ++axis) {
      ball.center[axis] +=
          path.reach[axis] * std::sin(2.0F * std::numbers::pi_v<float> * turn[axis]);
    }
    balls.push_back(ball);
  }
  return balls;
}

Mesh Metaballs::at_frame(int frame) const {
  const std::vector<Ball> balls = balls_at(frame);
  Mesh mesh = marching_cubes(sampled(settings_, balls), kLevel);
  mesh.normals.reserve(mesh.positions.size());
  for (const glm::vec3& p : mesh.positions) mesh.normals.push_back(normal_at(balls, p));
  return mesh;
}

std::vector<GeneratedPart> metaballs(base::MapReader& reader) {
  MetaballSettings settings;
  settings.seed = static_cast<std::uint64_t>(reader.integer("seed", 1));
  settings.balls = read_count(reader.require("balls"), "balls", 1, kMaxBalls);
  if (const auto* node = reader.find("resolution")) {
    settings.resolution = read_count(*node, "resolution", kLeastResolution, kMaxResolution);
  }
  settings.size_m = read_vec3(reader.require("size"), "size");
  const base::Node& radius = reader.require("radius");
  const auto radii = base::number_list(radius, "radius", 2);
  settings.least_radius_m = static_cast<float>(radii[0]);
  settings.greatest_radius_m = static_cast<float>(radii[1]);
  if (const auto* node = reader.find("frames")) {
    settings.frames = read_count(*node, "frames", 1, kMaxFrames);
  }
  const float shortest_m = std::min({settings.size_m.x, settings.size_m.y, settings.size_m.z});
  const bool is_ordered =
      0.0F < settings.least_radius_m && settings.least_radius_m <= settings.greatest_radius_m;
  if (!is_ordered || 2.0F * settings.greatest_radius_m > shortest_m) {
    throw base::InputError(
        radius.place(),
        fmt::format("radius [{}, {}]: must satisfy 0 < least <= greatest <= half the shortest side "
                    "of size, {}",
                    radii[0], radii[1], 0.5F * shortest_m));
  }
  GeneratedPart part;
  part.name = "balls";
  part.material.albedo = glm::vec3(kAlbedo);
  auto balls = std::make_shared<const Metaballs>(settings);
  part.mesh = balls->at_frame(0);
  if (settings.frames > 1) part.sequence = std::move(balls);
  std::vector<GeneratedPart> parts;
  parts.push_back(std::move(part));
  return parts;
}

}  // namespace renderers::scene

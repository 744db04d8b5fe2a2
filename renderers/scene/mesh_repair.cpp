#include "renderers/scene/mesh_repair.h"

#include "perception/base/errors.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace renderers::scene {
namespace {

/// Smallest height of a triangle over its longest edge: about the spacing of floats.
constexpr double kMinRelativeHeight = 1e-7;

template <typename Vector>
bool is_finite(const Vector& v) {
  for (int i = 0; i < Vector::length(); ++i) {
    if (!std::isfinite(v[i])) return false;
  }
  return true;
}

template <typename Vector>
void check_finite(const std::vector<Vector>& values, const std::string& what, const char* kind) {
  const auto bad = std::ranges::find_if_not(values, is_finite<Vector>);
  if (bad == values.end()) return;
  throw base::InputError(
      fmt::format("{}: {} {} is not finite", what, kind, std::distance(values.begin(), bad)));
}

bool has_area(const Mesh& mesh, const glm::uvec3& triangle) {
  const glm::dvec3 a(mesh.positions[triangle.x]);
  const glm::dvec3 b(mesh.positions[triangle.y]);
  const glm::dvec3 c(mesh.positions[triangle.z]);
  const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
  return glm::length(glm::cross(b - a, c - a)) > kMinRelativeHeight * longest * longest;
}

/// Unit vector, or zero for the zero vector.
glm::dvec3 unit(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : v;
}

}  // namespace

void check_mesh(const Mesh& mesh, const std::string& what) {
  check_finite(mesh.positions, what, "vertex");
  check_finite(mesh.uvs, what, "uv");
  for (const glm::uvec3& t : mesh.triangles) {
    const unsigned largest = std::max({t.x, t.y, t.z});
    if (largest >= mesh.positions.size()) {
      throw base::InputError(
          fmt::format("{}: a face asks for vertex {} of {}", what, largest, mesh.positions.size()));
    }
  }
}

std::size_t drop_zero_area_triangles(Mesh& mesh) {
  return std::erase_if(mesh.triangles, [&](const glm::uvec3& t) { return !has_area(mesh, t); });
}

std::vector<std::size_t> position_numbers(const Mesh& mesh) {
  std::map<std::tuple<float, float, float>, std::size_t> known;
  std::vector<std::size_t> numbers;
  numbers.reserve(mesh.positions.size());
  for (const glm::vec3& p : mesh.positions) {
    numbers.push_back(known.emplace(std::tuple(p.x, p.y, p.z), known.size()).first->second);
  }
  return numbers;
}

void make_smooth_normals(Mesh& mesh) {
  const std::vector<std::size_t> numbers = position_numbers(mesh);
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (const glm::uvec3& t : mesh.triangles) {
    const std::array<glm::dvec3, 3> p{mesh.positions[t.x], mesh.positions[t.y],
                                      mesh.positions[t.z]};
    const glm::dvec3 face_normal = unit(glm::cross(p[1] - p[0], p[2] - p[0]));
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3 to_next = unit(p[(i + 1) % 3] - p[i]);
      const glm::dvec3 to_last = unit(p[(i + 2) % 3] - p[i]);
      const double angle_rad = std::acos(std::clamp(glm::dot(to_next, to_last), -1.0, 1.0));
      sums[numbers[t[static_cast<int>(i)]]] += angle_rad * face_normal;
    }
  }
  // A position without a face, or whose faces cancel, gets any unit normal.
  mesh.normals.resize(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    const glm::dvec3 normal = unit(sums[numbers[i]]);
    mesh.normals[i] = glm::length(normal) > 0.5 ? glm::vec3(normal) : glm::vec3(0.0F, 1.0F, 0.0F);
  }
}

}  // namespace renderers::scene

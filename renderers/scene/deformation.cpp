#include "renderers/scene/deformation.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace renderers::scene {
namespace {

using Numbers = std::array<double, 3>;

constexpr double kPi = std::numbers::pi;

/// sin(x) / x, also at 0.
double sinc(double x) { return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x; }

/// glm's matrices are indexed by column first: the derivative of `row` by `column`.
double& entry(glm::dmat3& matrix, int row, int column) { return matrix[column][row]; }

/// Turns the two other coordinates by rate * height about the axis; determinant 1.
DeformedPoint twist(const Deformation& d, double rate_rad_per_m, const glm::dvec3& point) {
  const int a = d.axis;
  const int b = (a + 1) % 3;
  const int c = (a + 2) % 3;
  const glm::dvec3 p = point - d.center;
  const double cosine = std::cos(rate_rad_per_m * p[a]);
  const double sine = std::sin(rate_rad_per_m * p[a]);
  DeformedPoint result{point, glm::dmat3(1.0)};
  const double new_b = p[b] * cosine - p[c] * sine;
  const double new_c = p[b] * sine + p[c] * cosine;
  result.position[b] = d.center[b] + new_b;
  result.position[c] = d.center[c] + new_c;
  entry(result.jacobian, b, b) = cosine;
  entry(result.jacobian, b, c) = -sine;
  entry(result.jacobian, b, a) = -rate_rad_per_m * new_c;
  entry(result.jacobian, c, b) = sine;
  entry(result.jacobian, c, c) = cosine;
  entry(result.jacobian, c, a) = rate_rad_per_m * new_b;
  return result;
}

/// Bends the axis to a circle of radius 1 / curvature between `from` and `to`, straight outside;
/// determinant 1 - curvature * distance towards the circle's centre, 1 outside.
DeformedPoint bend(const Deformation& d, const Numbers& numbers, const glm::dvec3& point) {
  const auto [curvature, from_m, to_m] = numbers;
  const int y = d.axis;
  const int z = d.towards;
  const glm::dvec3 p = point - d.center;
  const double bent = std::clamp(p[y], from_m, to_m);
  const double straight = p[y] - bent;
  const double angle = curvature * bent;
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  // Written so that curvature 0 needs no case: sin(ks)/k and (1 - cos(ks))/k.
  const double along = bent * sinc(angle);
  const double across = bent * std::sin(0.5 * angle) * sinc(0.5 * angle);
  DeformedPoint result{point, glm::dmat3(1.0)};
  result.position[y] = d.center[y] + along + cosine * straight - sine * p[z];
  result.position[z] = d.center[z] + across + sine * straight + cosine * p[z];
  const double stretch = straight == 0.0 ? 1.0 - curvature * p[z] : 1.0;
  entry(result.jacobian, y, y) = cosine * stretch;
  entry(result.jacobian, y, z) = -sine;
  entry(result.jacobian, z, y) = sine * stretch;
  entry(result.jacobian, z, z) = cosine;
  return result;
}

/// Moves points by amplitude * ramp * sin(2 pi x / wavelength + phase); determinant 1.
DeformedPoint wave(const Deformation& d, const Numbers& numbers, const glm::dvec3& point) {
  const auto [amplitude_m, wavelength_m, phase_rad] = numbers;
  const double wave_number = 2.0 * kPi / wavelength_m;
  const double angle = wave_number * point[d.axis] + phase_rad;
  double ramp = 1.0;
  double ramp_slope = 0.0;
  if (d.ramp_axis >= 0) {
    const double width_m = d.ramp_to_m - d.ramp_from_m;
    const double t = (point[d.ramp_axis] - d.ramp_from_m) / width_m;
    ramp = std::clamp(t, 0.0, 1.0);
    if (t > 0.0 && t < 1.0) ramp_slope = 1.0 / width_m;
  }
  DeformedPoint result{point, glm::dmat3(1.0)};
  result.position[d.towards] += amplitude_m * ramp * std::sin(angle);
  entry(result.jacobian, d.towards, d.axis) += amplitude_m * ramp * wave_number * std::cos(angle);
  if (d.ramp_axis >= 0) {
    entry(result.jacobian, d.towards, d.ramp_axis) += amplitude_m * ramp_slope * std::sin(angle);
  }
  return result;
}

Numbers mix_numbers(const Numbers& a, const Numbers& b, float t) {
  Numbers mixed{};
  for (std::size_t i = 0; i < mixed.size(); ++i) mixed[i] = std::lerp(a[i], b[i], double{t});
  return mixed;
}

void check_not_folded(const DeformedPoint& point, const Deformation& deformation,
                      const Numbers& numbers) {
  if (glm::determinant(point.jacobian) > 0.0) return;
  throw base::InputError(
      deformation.place,
      fmt::format("bend of {:.6g} degrees per metre turns parts of the mesh inside out: they reach "
                  "beyond the circle's centre, {:.6g} m from the axis; lower curvature_deg_per_m",
                  numbers[0] * 180.0 / kPi, 1.0 / std::abs(numbers[0])));
}

}  // namespace

DeformedPoint deform_point(const Deformation& deformation, const std::array<double, 3>& numbers,
                           const glm::dvec3& point) {
  switch (deformation.type) {
    case DeformationType::bend:
      return bend(deformation, numbers, point);
    case DeformationType::twist:
      return twist(deformation, numbers[0], point);
    case DeformationType::wave:
      return wave(deformation, numbers, point);
  }
  return {point, glm::dmat3(1.0)};
}

Mesh deform(const Mesh& mesh, const std::vector<Deformation>& deformations, int frame) {
  Mesh result = mesh;
  for (const Deformation& deformation : deformations) {
    const Numbers numbers = deformation.numbers.at(frame, mix_numbers);
    for (std::size_t i = 0; i < result.positions.size(); ++i) {
      const DeformedPoint point =
          deform_point(deformation, numbers, glm::dvec3(result.positions[i]));
      check_not_folded(point, deformation, numbers);
      result.positions[i] = glm::vec3(point.position);
      if (result.normals.empty()) continue;
      const glm::dmat3 to_normal = glm::transpose(glm::inverse(point.jacobian));
      result.normals[i] = glm::vec3(glm::normalize(to_normal * glm::dvec3(result.normals[i])));
    }
  }
  return result;
}

int last_frame_of(const std::vector<Deformation>& deformations) {
  int last = 0;
  for (const Deformation& d : deformations) last = std::max(last, d.numbers.last_frame());
  return last;
}

DeformedMesh::DeformedMesh(std::shared_ptr<const Mesh> mesh, std::vector<Deformation> deformations)
    : mesh_(std::move(mesh)), deformations_(std::move(deformations)) {
  // What cannot be done at a key is found on reading.
  for (const Deformation& deformation : deformations_) {
    for (const auto& key : deformation.numbers.keys) deform(*mesh_, deformations_, key.frame);
  }
}

Mesh DeformedMesh::at_frame(int frame) const { return deform(*mesh_, deformations_, frame); }

bool DeformedMesh::is_animated() const {
  return std::ranges::any_of(deformations_,
                             [](const Deformation& d) { return d.numbers.is_animated; });
}

}  // namespace renderers::scene

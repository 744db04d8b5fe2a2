#pragma once

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace renderers::test {

/// f of a lobe of GGX for an albedo of 1, 1/sr, as printed and in double: D of Walter et al. 2007,
/// Eq. 33; Lambda and the height-correlated G2 = 1 / (1 + Lambda(o) + Lambda(i)) of Heitz 2014,
/// Eqs. 72 and 99 (numbers recalled). 0 where either direction lies below the surface.
/// @param normal, out, in  unit length; out to the viewer, in to the light
inline double ggx_value(double alpha, const glm::dvec3& normal, const glm::dvec3& out,
                        const glm::dvec3& in) {
  const double to_viewer = glm::dot(normal, out);
  const double to_light = glm::dot(normal, in);
  if (to_viewer <= 0.0 || to_light <= 0.0) return 0.0;
  const double a2 = alpha * alpha;
  const double h = glm::dot(normal, glm::normalize(out + in));
  const double d = a2 / (std::numbers::pi * std::pow(h * h * (a2 - 1.0) + 1.0, 2));
  const auto lambda = [&](double cosine) {
    const double tangent2 = (1.0 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1.0 + a2 * tangent2) - 1.0);
  };
  return d / (1.0 + lambda(to_viewer) + lambda(to_light)) / (4.0 * to_viewer * to_light);
}

}  // namespace renderers::test

#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "renderers/element_hierarchy/element.h"

namespace renderers::element_hierarchy {

/// Form factor from a surface point to a triangle, as far as it is above the point's horizon; the
/// triangle's two sides count alike: integral of cos / pi over its solid angle.
///
/// Lambert's formula, F = 1 / (2 pi) sum of theta_i (n . g_i) over the edges, theta_i the angle
/// under which the point sees edge i and g_i the unit normal of the plane through both.
/// Source: Baum, Rushmeier, Winget 1989, "Improving Radiosity Solutions Through the Use of
/// Analytically Determined Form-Factors", doi:10.1145/74333.74367 (Eq. recalled).
/// @param normal  unit length  @return in [0, 1]; 0 from within the triangle's plane
double point_form_factor(const glm::vec3& point, const glm::vec3& normal,
                         const std::array<glm::vec3, 3>& triangle);

/// Mean of cos / pi per direction over a triangle: integral of d / pi over its solid angle, d the
/// unit direction. The dot product with a normal whose horizon does not cut the triangle is the
/// form factor: Lambert's formula without the normal.
glm::dvec3 vector_form_factor(const glm::vec3& point, const std::array<glm::vec3, 3>& triangle);

/// True if no point of one patch can see the front of the other's.
bool face_away(const Element& a, const Element& b);

}  // namespace renderers::element_hierarchy

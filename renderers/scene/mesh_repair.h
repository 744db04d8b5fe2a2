#pragma once

#include "renderers/scene/scene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace renderers::scene {

/// @param what  names the mesh in the message
/// @throws base::InputError for a NaN or infinite vertex or uv, an index without a vertex
void check_mesh(const Mesh& mesh, const std::string& what);

/// Removes triangles whose height is below 1e-7 of their longest edge (the resolution of float).
/// @return how many were removed
std::size_t drop_zero_area_triangles(Mesh& mesh);

/// For each vertex the number of its position, from 0; exactly equal positions have equal numbers.
std::vector<std::size_t> position_numbers(const Mesh& mesh);

/// Gives every position one normal: the mean of its faces' normals weighted by their angle there
/// (Thürmer and Wüthrich 1998, Journal of Graphics Tools 3(1)). Vertices at exactly the same
/// position count as one.
void make_smooth_normals(Mesh& mesh);

}  // namespace renderers::scene

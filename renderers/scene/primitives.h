#pragma once

#include "perception/base/document.h"
#include "renderers/scene/scene.h"

/// Shapes written out in a scene file. All are counter-clockwise seen from the front.
namespace renderers::scene {

/// {origin, edge_u, edge_v, segments: 1}: a parallelogram whose front is cross(edge_u, edge_v); uv
/// runs along the edges. `segments` along both edges, or [u, v]: finer quads with normals, which
/// stay smooth when they are deformed. @throws base::InputError if the edges are parallel
Mesh read_quad(const base::Node& node);

/// [[p, p, p, ...], ...]: polygons of at least three corners, counter-clockwise seen from the
/// front, each cut into a fan from its first corner.
Mesh read_polygons(const base::Node& node);

/// {min, max, facing: out | in, omit: [], segments: 1}: an axis-aligned box of 12 triangles.
/// `omit` leaves sides out: -x, +x, -y, +y, -z, +z; `segments` as of a quad, on every side.
/// @throws base::InputError unless min < max in every axis, and for a box without sides
Mesh read_box(const base::Node& node);

/// {center, radius, segments: 32, facing: out | in}: `segments` around, half as many from pole to
/// pole, vertices on the sphere, smooth normals.
Mesh read_sphere(const base::Node& node);

/// {center, normal, radius, segments: 32}: a fan around the centre.
Mesh read_disk(const base::Node& node);

}  // namespace renderers::scene

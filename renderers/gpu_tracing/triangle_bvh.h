#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::gpu_tracing {

/// A box of the hierarchy, std430 (`BvhNode` of shaders/bvh.glsl).
struct BvhNode {
  glm::vec3 low{0.0F};     ///< m, world space, padded
  std::uint32_t skip = 0;  ///< the node to go on with if the ray misses the box
  glm::vec3 high{0.0F};
  std::uint32_t leaf = 0;  ///< 0: inner node; else first triangle x 16 + number of triangles
};

/// A triangle in world space, std430 (`BvhTriangle` of shaders/bvh.glsl).
struct BvhTriangle {
  glm::vec3 a{0.0F};  ///< m; counter-clockwise from the front
  std::uint32_t object = 0;
  glm::vec3 b{0.0F};
  std::uint32_t triangle = 0;  ///< index into the object's mesh
  glm::vec3 c{0.0F};
  std::uint32_t unused = 0;
};

/// Triangles in boxes in boxes. Nodes stand in depth-first order, the first child of an inner node
/// right after it and the larger child first; `skip` leads past everything inside a node. A ray
/// thus needs no stack, and where it stands is one number. Boxes are padded by four roundings of
/// the scene's largest coordinate: an axis-parallel triangle has a box with a volume.
///
/// Source: Smits 1998, "Efficiency Issues for Ray Tracing", JGT 3(2),
/// doi:10.1080/10867651.1998.10487488 (skip links). The tree is Embree's: binned surface area
/// heuristic, Wald 2007, doi:10.1109/RT.2007.4342588.
struct TriangleBvh {
  /// The low bits of `BvhNode::leaf`.
  static constexpr std::uint32_t kLeafCountRange = 16;

  std::vector<BvhNode> nodes;  ///< empty without triangles
  std::vector<BvhTriangle> triangles;
};

/// @param triangles  those with a coordinate that is not finite are left out, as Embree does
/// @throws base::DeviceError if Embree fails or memory runs out
TriangleBvh build_bvh(const std::vector<BvhTriangle>& triangles);

/// All triangles of a scene, corners to the bit those that `rays` meets.
TriangleBvh build_bvh(const ray_tracing::RayScene& rays);

}  // namespace renderers::gpu_tracing

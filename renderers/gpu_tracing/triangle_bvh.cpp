#include "renderers/gpu_tracing/triangle_bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include <embree3/rtcore.h>
#include <glm/common.hpp>

#include "perception/base/errors.h"

namespace renderers::gpu_tracing {

namespace {

/// 2, 4 and 8 are equally fast on Mesa's software driver, 1 is 4 % slower; ours.
constexpr std::uint32_t kMostLeafTriangles = 4;
constexpr std::uint32_t kMostDepth = 96;
/// Roundings of the scene's largest coordinate that boxes are padded by.
constexpr float kPaddingUlps = 4.0F;

static_assert(kMostLeafTriangles < TriangleBvh::kLeafCountRange);
static_assert(sizeof(BvhNode) == 32 && sizeof(BvhTriangle) == 48);

struct Box {
  glm::vec3 low{std::numeric_limits<float>::infinity()};
  glm::vec3 high{-std::numeric_limits<float>::infinity()};

  void add(const glm::vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void add(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  float half_area() const {
    const glm::vec3 side = high - low;
    return side.x * side.y + side.y * side.z + side.z * side.x;
  }
};

/// A node as Embree's builder makes it: two children, or triangles.
struct BuiltNode {
  std::array<BuiltNode*, 2> children{};
  Box box;
  std::uint32_t count = 0;
  std::array<std::uint32_t, kMostLeafTriangles> triangles{};
};

BuiltNode* new_node(RTCThreadLocalAllocator allocator) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), alignof(BuiltNode))) BuiltNode;
}

void* create_inner(RTCThreadLocalAllocator allocator, unsigned, void*) {
  return new_node(allocator);
}

void set_children(void* node, void** children, unsigned count, void*) {
  for (unsigned i = 0; i < count; ++i) {
    static_cast<BuiltNode*>(node)->children[i] = static_cast<BuiltNode*>(children[i]);
  }
}

/// Boxes are joined from the leaves up when the nodes are put in order.
void ignore_bounds(void*, const RTCBounds**, unsigned, void*) {}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives,
                  std::size_t count, void*) {
  BuiltNode* node = new_node(allocator);
  node->count = static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    node->triangles[i] = primitives[i].primID;
    const RTCBuildPrimitive& p = primitives[i];
    node->box.add(glm::vec3(p.lower_x, p.lower_y, p.lower_z));
    node->box.add(glm::vec3(p.upper_x, p.upper_y, p.upper_z));
  }
  return node;
}

bool is_finite(const BvhTriangle& triangle) {
  const auto is_point = [](const glm::vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  return is_point(triangle.a) && is_point(triangle.b) && is_point(triangle.c);
}

std::vector<RTCBuildPrimitive> padded_boxes(const std::vector<BvhTriangle>& triangles) {
  float largest = 0.0F;
  for (const BvhTriangle& t : triangles) {
    const glm::vec3 extent = glm::max(glm::abs(t.a), glm::max(glm::abs(t.b), glm::abs(t.c)));
    largest = std::max({largest, extent.x, extent.y, extent.z});
  }
  const glm::vec3 padding(std::max(kPaddingUlps * std::numeric_limits<float>::epsilon() * largest,
                                   std::numeric_limits<float>::min()));
  std::vector<RTCBuildPrimitive> boxes(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const BvhTriangle& t = triangles[i];
    const glm::vec3 low = glm::min(t.a, glm::min(t.b, t.c)) - padding;
    const glm::vec3 high = glm::max(t.a, glm::max(t.b, t.c)) + padding;
    boxes[i] = {low.x, low.y, low.z, 0U, high.x, high.y, high.z, static_cast<unsigned>(i)};
  }
  return boxes;
}

/// Joins the boxes of a subtree and brings its larger children to the front.
void join_boxes(BuiltNode& node) {
  if (node.count > 0) return;
  for (BuiltNode* child : node.children) {
    join_boxes(*child);
    node.box.add(child->box);
  }
  if (node.children[0]->box.half_area() < node.children[1]->box.half_area()) {
    std::swap(node.children[0], node.children[1]);
  }
}

void append(const BuiltNode& node, const std::vector<BvhTriangle>& triangles, TriangleBvh& bvh) {
  const std::size_t index = bvh.nodes.size();
  bvh.nodes.push_back({node.box.low, 0, node.box.high, 0});
  if (node.count > 0) {
    const auto first = static_cast<std::uint32_t>(bvh.triangles.size());
    bvh.nodes[index].leaf = first * TriangleBvh::kLeafCountRange + node.count;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      bvh.triangles.push_back(triangles[node.triangles[i]]);
    }
  } else {
    for (const BuiltNode* child : node.children) append(*child, triangles, bvh);
  }
  bvh.nodes[index].skip = static_cast<std::uint32_t>(bvh.nodes.size());
}

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct BvhRelease {
  void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};

/// Runs Embree's builder. @return the root; lives as long as `bvh`
BuiltNode* build_tree(RTCDevice device, RTCBVH bvh, std::vector<RTCBuildPrimitive>& boxes) {
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.maxDepth = kMostDepth;
  arguments.maxLeafSize = kMostLeafTriangles;
  arguments.bvh = bvh;
  arguments.primitives = boxes.data();
  arguments.primitiveCount = boxes.size();
  arguments.primitiveArrayCapacity = boxes.size();
  arguments.createNode = create_inner;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = ignore_bounds;
  arguments.createLeaf = create_leaf;
  auto* root = static_cast<BuiltNode*>(rtcBuildBVH(&arguments));
  if (root == nullptr) {
    throw base::DeviceError("Embree: error " + std::to_string(rtcGetDeviceError(device)) +
                            " while building a BVH of " + std::to_string(boxes.size()) +
                            " triangles");
  }
  return root;
}

}  // namespace

TriangleBvh build_bvh(const std::vector<BvhTriangle>& triangles) {
  std::vector<BvhTriangle> finite;
  finite.reserve(triangles.size());
  std::ranges::copy_if(triangles, std::back_inserter(finite), is_finite);
  TriangleBvh bvh;
  if (finite.empty()) return bvh;
  std::vector<RTCBuildPrimitive> boxes = padded_boxes(finite);
  const std::unique_ptr<RTCDeviceTy, DeviceRelease> device(rtcNewDevice(nullptr));
  if (!device) throw base::DeviceError("Embree: no device for building a BVH");
  const std::unique_ptr<RTCBVHTy, BvhRelease> tree(rtcNewBVH(device.get()));
  BuiltNode* root = build_tree(device.get(), tree.get(), boxes);
  join_boxes(*root);
  bvh.triangles.reserve(finite.size());
  append(*root, finite, bvh);
  return bvh;
}

TriangleBvh build_bvh(const ray_tracing::RayScene& rays) {
  std::vector<BvhTriangle> triangles;
  triangles.reserve(rays.triangle_count());
  for (std::uint32_t object = 0; object < rays.scene().objects.size(); ++object) {
    const auto count =
        static_cast<std::uint32_t>(rays.scene().objects[object].mesh->triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
      const auto& [a, b, c] = rays.triangle_corners(object, t);
      triangles.push_back({a, object, b, t, c, 0});
    }
  }
  return build_bvh(triangles);
}

}  // namespace renderers::gpu_tracing

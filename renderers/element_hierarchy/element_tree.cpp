#include "renderers/element_hierarchy/element_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <glm/common.hpp>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "renderers/element_hierarchy/cluster_split.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::element_hierarchy {

namespace {

constexpr float kPi = ray_tracing::kPi;
/// Children of a cluster.
constexpr std::size_t kBranching = 4;

glm::vec2 interpolate(const std::array<glm::vec2, 3>& corners, const glm::vec2& weights) {
  return (1.0F - weights.x - weights.y) * corners[0] + weights.x * corners[1] +
         weights.y * corners[2];
}

void bound_patch(Element& patch) {
  const auto& p = patch.positions;
  patch.box_min = glm::min(p[0], glm::min(p[1], p[2]));
  patch.box_max = glm::max(p[0], glm::max(p[1], p[2]));
}

/// Cuts a range of patches into at most four.
std::vector<std::span<Element>> cut_in_four(std::span<Element> patches) {
  std::vector<std::span<Element>> parts{patches};
  while (parts.size() < kBranching) {
    const auto largest = std::ranges::max_element(
        parts, {}, [](const std::span<Element>& part) { return part.size(); });
    if (largest->size() < 2) break;
    const std::size_t first = split_cluster(*largest);
    const std::span<Element> rest = largest->subspan(first);
    *largest = largest->first(first);
    parts.insert(largest + 1, rest);
  }
  return parts;
}

}  // namespace

ElementTree::ElementTree(const ray_tracing::RayScene& rays, const LitSides& sides)
    : rays_(&rays), pieces_(sides.pieces) {
  std::vector<Element> patches;
  add_sides(sides, patches);
  if (patches.empty()) {
    throw base::InputError("hierarchical radiosity: scene \"" + rays.scene().name +
                           "\" has no surface that light reaches; accepted: at least one triangle "
                           "with an area that a light, an emissive front or the environment sees");
  }
  base::parallel_for(patches.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sum_materials(patches[i]);
  });
  build_clusters(patches);
}

void ElementTree::add_sides(const LitSides& sides, std::vector<Element>& patches) {
  root_at_.resize(sides.is_lit.size(), kNoElement);
  for (std::size_t i = 0; i < pieces_->count(); ++i) {
    const SurfacePieces::Piece piece = pieces_->at(i);
    if (!(piece.area_m2 > 0.0F)) {
      ++degenerate_;
      continue;
    }
    for (const bool is_back : {false, true}) {
      if (!sides.is_lit[2 * i + (is_back ? 1 : 0)]) continue;
      Element patch;
      patch.is_patch = true;
      patch.is_back = is_back;
      patch.object = piece.object;
      patch.triangle = piece.triangle;
      patch.area_m2 = piece.area_m2;
      patch.corners = piece.corners;
      if (is_back) std::swap(patch.corners[1], patch.corners[2]);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto point = rays_->point_on_triangle(piece.object, piece.triangle, patch.corners[c]);
        patch.positions[c] = point.position;
        patch.normal = is_back ? -point.geometric_normal : point.geometric_normal;
      }
      bound_patch(patch);
      patches.push_back(patch);
    }
  }
}

/// Means of reflectance and emission over a patch: of the textures at 16 points, cell centres of
/// two triangular subdivisions.
void ElementTree::sum_materials(Element& patch) const {
  const scene::Scene& scene = rays_->scene();
  const auto index = static_cast<std::size_t>(scene.objects[patch.object].material);
  const scene::Material& material = scene.materials[index];
  const bool has_albedo_texture = material.albedo_texture != scene::kNoTexture;
  const bool has_emission_texture = material.emission_texture != scene::kNoTexture;
  glm::vec3 albedo(has_albedo_texture ? 0.0F : 1.0F);
  glm::vec3 emission(has_emission_texture ? 0.0F : 1.0F);
  constexpr int kCells = 4;  // along an edge
  constexpr float kWeight = 1.0F / (kCells * kCells);
  for (int cell = 0; (has_albedo_texture || has_emission_texture) && cell < kCells * kCells;
       ++cell) {
    // Rows of triangles, pointing up and down in turn.
    const int row = static_cast<int>(std::sqrt(static_cast<float>(cell)));
    const int column = cell - row * row;
    const float u = (static_cast<float>(column / 2) + (column % 2 == 0 ? 1.0F : 2.0F) / 3.0F) /
                    static_cast<float>(kCells);
    const float sum = (static_cast<float>(row) + (column % 2 == 0 ? 2.0F : 1.0F) / 3.0F) /
                      static_cast<float>(kCells);
    const auto point = rays_->point_on_triangle(patch.object, patch.triangle,
                                                interpolate(patch.corners, {u, sum - u}));
    const auto look_up = [&](int texture) {
      return kWeight *
             scene::sample_texture(scene.textures[static_cast<std::size_t>(texture)], point.uv);
    };
    if (has_albedo_texture) albedo += look_up(material.albedo_texture);
    if (has_emission_texture) emission += look_up(material.emission_texture);
  }
  patch.reflectance = material.albedo * albedo;
  if (!patch.is_back) patch.emitted_w_m2 = kPi * material.emission * emission;
}

void ElementTree::build_clusters(std::vector<Element>& patches) {
  struct Open {
    std::uint32_t element;
    std::span<Element> patches;
  };
  const auto offset_of = [&](const std::span<Element>& part) {
    return static_cast<std::uint32_t>(part.data() - patches.data());
  };
  std::vector<Open> open{{0, patches}};
  elements_.emplace_back();
  for (std::size_t i = 0; i < open.size(); ++i) {
    const Open node = open[i];
    const std::uint32_t first = offset_of(node.patches);
    const std::uint32_t parent = elements_[node.element].parent;
    if (node.patches.size() == 1) {
      elements_[node.element] = node.patches.front();
    } else {
      const auto parts = cut_in_four(node.patches);
      elements_[node.element].first_child = static_cast<std::uint32_t>(elements_.size());
      elements_[node.element].child_count = static_cast<std::uint8_t>(parts.size());
      for (const std::span<Element>& part : parts) {
        open.push_back({static_cast<std::uint32_t>(elements_.size()), part});
        elements_.emplace_back().parent = node.element;
      }
    }
    elements_[node.element].parent = parent;
    elements_[node.element].root_begin = first;
    elements_[node.element].root_end = first + static_cast<std::uint32_t>(node.patches.size());
  }
  roots_.resize(patches.size());
  area_before_m2_.resize(patches.size() + 1, 0.0);
  for (std::uint32_t i = static_cast<std::uint32_t>(elements_.size()); i-- > 0;) {
    Element& element = elements_[i];
    if (element.is_patch) {
      roots_[element.root_begin] = i;
      root_at_[side_of(i)] = i;
      continue;
    }
    for (std::uint32_t c = 0; c < element.child_count; ++c) {
      const Element& child = elements_[element.first_child + c];
      element.box_min = glm::min(element.box_min, child.box_min);
      element.box_max = glm::max(element.box_max, child.box_max);
      element.area_m2 += child.area_m2;
      element.reflectance += child.area_m2 * child.reflectance;
      element.emitted_w_m2 += child.area_m2 * child.emitted_w_m2;
    }
    element.reflectance /= element.area_m2;
    element.emitted_w_m2 /= element.area_m2;
  }
  for (std::size_t i = 0; i < roots_.size(); ++i) {
    area_before_m2_[i + 1] = area_before_m2_[i] + static_cast<double>(elements_[roots_[i]].area_m2);
  }
}

std::uint32_t ElementTree::subdivide(std::uint32_t patch) {
  assert(elements_[patch].is_patch && elements_[patch].is_leaf());
  const auto first = static_cast<std::uint32_t>(elements_.size());
  Element& parent = elements_[patch];
  parent.first_child = first;
  parent.child_count = 4;
  Element child = parent;
  child.parent = patch;
  child.first_child = kNoElement;
  child.child_count = 0;
  child.area_m2 = 0.25F * parent.area_m2;
  const std::array<glm::vec2, 3> whole = parent.corners;
  for (std::uint32_t part = 0; part < 4; ++part) {
    child.corners = corners_of_part(whole, part);
    for (std::size_t i = 0; i < 3; ++i) {
      child.positions[i] =
          rays_->point_on_triangle(child.object, child.triangle, child.corners[i]).position;
    }
    bound_patch(child);
    sum_materials(child);
    elements_.push_back(child);
  }
  return first;
}

std::size_t ElementTree::side_of(std::uint32_t root) const {
  const Element& patch = elements_[root];
  const glm::vec2 middle = (patch.corners[0] + patch.corners[1] + patch.corners[2]) / 3.0F;
  return 2 * pieces_->place_of(patch.object, patch.triangle, middle).piece +
         (patch.is_back ? 1 : 0);
}

ElementTree::Place ElementTree::place_at(const ray_tracing::SurfacePoint& point,
                                         const glm::vec3& towards) const {
  const bool is_back = glm::dot(point.geometric_normal, towards) < 0.0F;
  const SurfacePieces::Place at =
      pieces_->place_of(point.object, point.triangle, point.barycentrics);
  const std::uint32_t root = root_at_[2 * at.piece + (is_back ? 1 : 0)];
  return root == kNoElement ? Place{} : place_below(root, at.weights);
}

ElementTree::Place ElementTree::place_below(std::uint32_t root, const glm::vec3& weights) const {
  Place place{root, weights};
  if (elements_[root].is_back) std::swap(place.weights.y, place.weights.z);
  while (!elements_[place.leaf].is_leaf()) {
    const std::uint32_t part = descend_to_part(place.weights);
    place.leaf = elements_[place.leaf].first_child + part;
  }
  return place;
}

std::uint32_t ElementTree::leaf_at(const ray_tracing::SurfacePoint& point,
                                   const glm::vec3& towards) const {
  return place_at(point, towards).leaf;
}

bool ElementTree::is_below(std::uint32_t element, std::uint32_t ancestor) const {
  // Parents come before children.
  while (element != kNoElement && element > ancestor) element = elements_[element].parent;
  return element == ancestor;
}

SidePoint ElementTree::sample(std::uint32_t element, glm::vec2 u,
                              std::span<const double> before) const {
  const Element* patch = &elements_[element];
  if (!patch->is_patch) {
    const double begin = before[patch->root_begin];
    const double end = before[patch->root_end];
    // Rounded up to the end it would fall on the last side, whose weight may be 0.
    const double target =
        std::min(begin + static_cast<double>(u.x) * (end - begin), std::nextafter(end, begin));
    const auto first = before.begin() + patch->root_begin + 1;
    const auto last = before.begin() + patch->root_end;
    const auto found = std::upper_bound(first, last, target);
    const auto root = static_cast<std::size_t>(found - before.begin()) - 1;
    patch = &elements_[roots_[root]];
    const double rest = (target - before[root]) / (before[root + 1] - before[root]);
    u.x = std::clamp(static_cast<float>(rest), 0.0F, 0x1.fffffep-1F);
  }
  return point_of(*patch, ray_tracing::uniform_triangle(u));
}

SidePoint ElementTree::point_of(const Element& patch, const glm::vec2& weights) const {
  return {
      rays_->point_on_triangle(patch.object, patch.triangle, interpolate(patch.corners, weights)),
      patch.normal, patch.root_begin};
}

std::int64_t ElementTree::memory_bytes() const {
  return pieces_->memory_bytes() +
         static_cast<std::int64_t>(elements_.capacity() * sizeof(Element) +
                                   roots_.capacity() * sizeof(std::uint32_t) +
                                   area_before_m2_.capacity() * sizeof(double) +
                                   root_at_.capacity() * sizeof(std::uint32_t));
}

}  // namespace renderers::element_hierarchy

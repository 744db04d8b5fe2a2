#include "renderers/element_hierarchy/surface_pieces.h"

#include <cmath>

namespace renderers::element_hierarchy {

namespace {

/// A million pieces; what is larger still stays so. Ours.
constexpr std::uint8_t kMostCuts = 10;

}  // namespace

std::uint32_t descend_to_part(glm::vec3& weights) {
  const glm::vec3 w = weights;
  std::uint32_t part = 3;
  // The middle part's corners face those of the whole.
  weights = glm::vec3(1.0F) - 2.0F * w;
  for (int corner = 0; corner < 3; ++corner) {
    if (w[corner] <= 0.5F) continue;
    part = static_cast<std::uint32_t>(corner);
    weights = 2.0F * w;
    weights[corner] -= 1.0F;
  }
  return part;
}

std::array<glm::vec2, 3> corners_of_part(const std::array<glm::vec2, 3>& c, std::uint32_t part) {
  const glm::vec2 ab = 0.5F * (c[0] + c[1]);
  const glm::vec2 bc = 0.5F * (c[1] + c[2]);
  const glm::vec2 ca = 0.5F * (c[2] + c[0]);
  const std::array<std::array<glm::vec2, 3>, 4> parts{
      {{c[0], ab, ca}, {ab, c[1], bc}, {ca, bc, c[2]}, {bc, ca, ab}}};
  return parts[part];
}

SurfacePieces::SurfacePieces(const ray_tracing::RayScene& rays, double most_means) : rays_(&rays) {
  const scene::Scene& scene = rays.scene();
  double area_m2 = 0.0;
  std::size_t triangles = 0;
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    first_triangle_.push_back(triangles);
    const std::size_t count = scene.objects[object].mesh->triangles.size();
    triangles += count;
    for (std::uint32_t t = 0; t < count; ++t) {
      area_m2 += static_cast<double>(rays.triangle_area_m2(object, t));
    }
  }
  const double most_m2 = most_means * area_m2 / static_cast<double>(triangles);
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    const std::size_t count = scene.objects[object].mesh->triangles.size();
    for (std::uint32_t t = 0; t < count; ++t) {
      auto left_m2 = static_cast<double>(rays.triangle_area_m2(object, t));
      std::uint8_t cuts = 0;
      for (; most_m2 > 0.0 && left_m2 > most_m2 && cuts < kMostCuts; left_m2 /= 4.0) ++cuts;
      first_.push_back(static_cast<std::uint32_t>(object_of_.size()));
      cuts_.push_back(cuts);
      const std::size_t pieces = std::size_t{1} << (2U * cuts);
      object_of_.resize(object_of_.size() + pieces, object);
      triangle_of_.resize(triangle_of_.size() + pieces, t);
    }
  }
}

SurfacePieces::Piece SurfacePieces::at(std::size_t piece) const {
  Piece found;
  found.object = object_of_[piece];
  found.triangle = triangle_of_[piece];
  const std::size_t index = index_of(found.object, found.triangle);
  const std::size_t path = piece - first_[index];
  found.corners = {{{0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}}};
  found.area_m2 = rays_->triangle_area_m2(found.object, found.triangle);
  for (unsigned cut = cuts_[index]; cut-- > 0;) {
    const std::size_t part = (path >> (2U * cut)) & 3U;
    found.corners = corners_of_part(found.corners, static_cast<std::uint32_t>(part));
    found.area_m2 *= 0.25F;
  }
  return found;
}

SurfacePieces::Place SurfacePieces::place_of(std::uint32_t object, std::uint32_t triangle,
                                             const glm::vec2& barycentrics) const {
  const std::size_t index = index_of(object, triangle);
  Place place{0, {1.0F - barycentrics.x - barycentrics.y, barycentrics.x, barycentrics.y}};
  for (unsigned cut = cuts_[index]; cut-- > 0;) {
    place.piece = 4 * place.piece + descend_to_part(place.weights);
  }
  place.piece += first_[index];
  return place;
}

std::int64_t SurfacePieces::memory_bytes() const {
  return static_cast<std::int64_t>(
      first_triangle_.capacity() * sizeof(std::size_t) + first_.capacity() * sizeof(std::uint32_t) +
      cuts_.capacity() + (object_of_.capacity() + triangle_of_.capacity()) * sizeof(std::uint32_t));
}

}  // namespace renderers::element_hierarchy

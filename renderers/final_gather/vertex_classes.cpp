#include "renderers/final_gather/vertex_classes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "renderers/element_hierarchy/spherical_triangle.h"
#include "renderers/final_gather/link_gather.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::final_gather {

using element_hierarchy::Element;
using element_hierarchy::SidePoint;

namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

/// Cells around a vertex and what the camera sees in them.
struct VertexClassifier::Neighbourhood : Surrounding {
  std::uint32_t vertex = 0;
  glm::dvec3 low{0.0};  ///< of the adjacent cells, in grid coordinates
  glm::dvec3 high{0.0};
  std::vector<ray_tracing::SurfacePoint> points;  ///< of the anchors, for `HitRule::surface`
};

/// Sums over the samples of a sender.
struct VertexClassifier::Sums {
  double least = std::numeric_limits<double>::infinity();
  double greatest = 0.0;
  double sum = 0.0;
  glm::dvec3 vector{0.0};
  int count = 0;
  int traced = 0;
  int seen = 0;
  glm::vec3 light{0.0F};  ///< W/m2, sum of the radiosities seen

  Spread spread() const {
    Spread spread;
    spread.least = least;
    spread.greatest = greatest;
    spread.mean = sum / count;
    if (seen == 0) return spread;
    spread.visibility = static_cast<double>(seen) / traced;
    spread.is_partly_visible = seen < traced;
    spread.radiosity = light / static_cast<float>(seen);
    return spread;
  }
};

VertexClassifier::VertexClassifier(const SenderClasses& classes, const GridAnchors& anchors,
                                   HitRule hit_rule)
    : classes_(classes),
      transfer_(classes.transfer()),
      anchors_(anchors),
      hit_rule_(hit_rule),
      counter_(classes.transfer().solution().tree->rays()),
      pixels_per_rad_(static_cast<double>(classes.perception().preview().height_px) /
                      anchors.grid().image_height_at_one()) {}

VertexClassifier::Neighbourhood VertexClassifier::neighbourhood_of(std::uint32_t vertex) const {
  Neighbourhood around;
  const GatherGrid& grid = anchors_.grid();
  around.vertex = vertex;
  around.place = grid.vertex(vertex);
  const glm::dvec3 place(grid.vertex_place(vertex));
  around.low = glm::max(place - 1.0, glm::dvec3(0.0));
  around.high = glm::min(place + 1.0, glm::dvec3(grid.size().x, grid.size().y, grid.size().z));
  around.anchors = anchors_.around(vertex);
  for (const Anchor* anchor : around.anchors) {
    around.leaves.push_back(anchor->leaf);
    if (hit_rule_ == HitRule::surface) around.points.push_back(point_of(*anchor));
  }
  std::ranges::sort(around.leaves);
  const auto repeated = std::ranges::unique(around.leaves);
  around.leaves.erase(repeated.begin(), repeated.end());
  // Vertices of a grid in the world can lie behind the camera that sees their cells.
  double depth_m = grid.view_depth_m(around.place);
  if (depth_m <= 0.0) {
    for (const Anchor* anchor : around.anchors) {
      depth_m = std::max(depth_m, grid.view_depth_m(anchor->place));
    }
  }
  around.pixels_per_m = pixels_per_rad_ / depth_m;
  around.cell_frequency_cpd =
      0.5 / classes_.perception().degrees(grid.cell_width_m(around.place) * around.pixels_per_m);
  return around;
}

GatherVertex VertexClassifier::classify(std::uint32_t vertex) const {
  Neighbourhood around = neighbourhood_of(vertex);
  GatherVertex result;
  const auto evaluate = [&](const Sender& sender, int samples) -> std::optional<ClassifiedSender> {
    const Sums sums = sample(around, sender, samples);
    result.visibility_rays += static_cast<std::uint64_t>(sums.traced);
    result.form_factor_samples += static_cast<std::uint64_t>(sums.count);
    if (sums.count == 0) return std::nullopt;
    ClassifiedSender classified = classes_.judge(around, sender, sums.spread(), result);
    classified.record.vector_form_factor = glm::vec3(sums.vector / static_cast<double>(sums.count));
    return classified;
  };
  const std::vector<std::uint32_t> near = classes_.classify(around, result, evaluate);
  if (!near.empty()) add_near(around, near, result);
  return result;
}

VertexClassifier::Sums VertexClassifier::sample(const Neighbourhood& around, const Sender& sender,
                                                int count) const {
  Sums sums;
  for (int i = 0; i < count; ++i) {
    add_sample(around, sender.element, static_cast<std::uint32_t>(i), sums);
  }
  return sums;
}

ray_tracing::SurfacePoint VertexClassifier::point_of(const Anchor& anchor) const {
  return transfer_.solution().tree->rays().point_on_triangle(anchor.object, anchor.triangle,
                                                             anchor.barycentrics);
}

void VertexClassifier::add_sample(const Neighbourhood& around, std::uint32_t sender,
                                  std::uint32_t index, Sums& sums) const {
  const auto& tree = *transfer_.solution().tree;
  const TransferSettings& transfer = transfer_.settings();
  const Element& element = tree.at(sender);
  const std::uint64_t key = transfer_.points().key(sender);
  const SenderPoint point = transfer_.points().fixed(sender, index);
  const SidePoint& to = point.side;
  // Where: among what the camera sees, or anywhere in the adjacent cells.
  const glm::vec4 u =
      ray_tracing::SampleSequence(ray_tracing::SequenceKind::sobol,
                                  ray_tracing::hash_combine(key, around.vertex), index)
          .next();
  ray_tracing::SurfacePoint start;
  const bool is_anchored = hit_rule_ == HitRule::surface;
  bool faces_sender = true;
  if (is_anchored) {
    const auto count = static_cast<float>(around.anchors.size());
    const auto chosen = static_cast<std::size_t>(u.x * count);
    start = around.points[chosen];
    const glm::vec3 normal =
        around.anchors[chosen]->is_back ? -start.geometric_normal : start.geometric_normal;
    faces_sender = glm::dot(normal, to.surface.position - start.position) > 0.0F;
  } else {
    start.position =
        anchors_.grid().to_world(around.low + glm::dvec3(u) * (around.high - around.low));
  }
  const glm::vec3 between = to.surface.position - start.position;
  const auto distance2 = static_cast<double>(glm::dot(between, between));
  if (!faces_sender || distance2 <= 0.0) return;
  const double distance_m = std::sqrt(distance2);
  const double cosine = -static_cast<double>(glm::dot(to.normal, between)) / distance_m;
  double omega = 0.0;
  if (cosine > 0.0) omega = static_cast<double>(element.area_m2) * cosine / distance2;
  if (transfer.is_exact && element.is_patch && cosine > 0.0) {
    omega = element_hierarchy::solid_angle(start.position, element.positions);
  }
  const double form_factor = omega / kPi;
  ++sums.count;
  sums.sum += form_factor;
  sums.least = std::min(sums.least, form_factor);
  sums.greatest = std::max(sums.greatest, form_factor);
  sums.vector += form_factor / distance_m * glm::dvec3(between);
  if (omega <= 0.0) return;
  ++sums.traced;
  const auto is_local = [&](const glm::vec3& place) {
    const glm::dvec3 at = anchors_.grid().to_grid(place);
    return glm::all(glm::greaterThanEqual(at, around.low)) &&
           glm::all(glm::lessThanEqual(at, around.high));
  };
  const bool is_occluded = is_anchored
                               ? tree.rays().is_occluded(segment_to(start, to.surface))
                               : counter_.is_occluded(start.position, to, hit_rule_, is_local);
  if (is_occluded) return;
  ++sums.seen;
  sums.light += point.radiosity;
}

void VertexClassifier::add_near(const Neighbourhood& around,
                                const std::vector<std::uint32_t>& senders,
                                GatherVertex& result) const {
  const TransferSettings& transfer = transfer_.settings();
  const std::uint64_t key = ray_tracing::hash_combine(transfer.points.seed, 0x5e1f + around.vertex);
  const float share_sr =
      4.0F * ray_tracing::kPi / static_cast<float>(classes_.settings().containing_rays);
  const std::size_t count = around.anchors.size();
  for (int i = 0; i < classes_.settings().containing_rays; ++i) {
    const glm::vec2 u =
        sender_position(transfer.points.positions, key, static_cast<std::uint32_t>(i));
    const float z = 1.0F - 2.0F * u.x;
    const float radius = std::sqrt(std::fmax(0.0F, 1.0F - z * z));
    const float azimuth_rad = 2.0F * ray_tracing::kPi * u.y;
    const glm::vec3 direction(radius * std::cos(azimuth_rad), radius * std::sin(azimuth_rad), z);
    ray_tracing::Ray ray{around.place, direction};
    if (hit_rule_ == HitRule::surface) {
      // From a surface that looks that way, if there is one.
      const std::size_t first =
          ray_tracing::hash_combine(key, static_cast<std::uint64_t>(i)) % count;
      bool is_found = false;
      for (std::size_t step = 0; step < count && !is_found; ++step) {
        const ray_tracing::SurfacePoint& point = around.points[(first + step) % count];
        const float side = around.anchors[(first + step) % count]->is_back ? -1.0F : 1.0F;
        is_found = side * glm::dot(point.geometric_normal, direction) > 0.0F;
        if (is_found) ray = ray_from(point, direction);
      }
      if (!is_found) continue;
    }
    ++result.visibility_rays;
    const glm::vec3 radiosity = radiosity_on(transfer_.solution(), ray, senders);
    result.around.add(direction, share_sr / ray_tracing::kPi * radiosity);
  }
}

}  // namespace renderers::final_gather

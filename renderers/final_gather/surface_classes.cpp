#include "renderers/final_gather/surface_classes.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "renderers/final_gather/link_gather.h"
#include "renderers/final_gather/surface_choice.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::final_gather {

using element_hierarchy::Element;
using element_hierarchy::SidePoint;

namespace {

/// On the lit side of a patch.
Receiver receiver_at(const SidePoint& point) {
  const float side = glm::dot(point.surface.geometric_normal, point.normal) < 0.0F ? -1.0F : 1.0F;
  return {point.surface, side * point.surface.shading_normal, 0};
}

/// A point on patches, uniform by area. @param u  three numbers in [0, 1)
SidePoint point_on(const element_hierarchy::ElementTree& tree,
                   const std::vector<std::uint32_t>& leaves, const glm::vec4& u) {
  float area_m2 = 0.0F;
  for (const std::uint32_t leaf : leaves) area_m2 += tree.at(leaf).area_m2;
  float left_m2 = u.x * area_m2;
  std::size_t chosen = 0;
  while (chosen + 1 < leaves.size() && left_m2 >= tree.at(leaves[chosen]).area_m2) {
    left_m2 -= tree.at(leaves[chosen++]).area_m2;
  }
  return tree.sample(leaves[chosen], {u.y, u.z});
}

}  // namespace

SurfaceClassifier::SurfaceClassifier(const SenderClasses& classes, const SurfaceVertices& surface,
                                     VertexVisibility visibility, const SurfaceViewpoint& viewpoint)
    : classes_(classes),
      transfer_(classes.transfer()),
      surface_(surface),
      visibility_(visibility),
      viewpoint_(viewpoint) {}

Surrounding SurfaceClassifier::surrounding_of(std::size_t site) const {
  Surrounding around;
  around.place = surface_.place(site).surface.position;
  around.anchors = surface_.anchors(site);
  const auto leaves = surface_.leaves(site);
  around.leaves.assign(leaves.begin(), leaves.end());
  // Vertices of large patches can lie behind the camera: what counts is where they are seen.
  double depth_m = 0.0;
  double weight = 0.0;
  for (const Anchor* anchor : around.anchors) {
    const auto share = static_cast<double>(anchor->weight);
    depth_m += share *
               static_cast<double>(glm::dot(anchor->place - viewpoint_.camera, viewpoint_.forward));
    weight += share;
  }
  around.pixels_per_m = viewpoint_.pixels_per_rad / (depth_m / weight);
  double width = 0.0;
  for (const std::uint32_t leaf : leaves) width += width_m(surface_.tree().at(leaf));
  width /= static_cast<double>(leaves.size());
  around.cell_frequency_cpd = 0.5 / classes_.perception().degrees(width * around.pixels_per_m);
  return around;
}

std::vector<Receiver> SurfaceClassifier::receivers_of(std::size_t site) const {
  constexpr std::size_t kMost = 8;
  const SidePoint place = surface_.place(site);
  std::vector<Receiver> corners;
  for (const std::uint32_t leaf : surface_.leaves(site)) {
    const Element& patch = surface_.tree().at(leaf);
    const auto near_m = static_cast<float>(0.1 * width_m(patch));
    for (int c = 0; c < 3; ++c) {
      const Receiver corner = receiver_at(surface_.tree().point_of(patch, inside_corner(c)));
      const auto is_near_corner = [&](const Receiver& other) {
        return glm::distance(other.point.position, corner.point.position) < near_m;
      };
      if (std::ranges::none_of(corners, is_near_corner)) corners.push_back(corner);
    }
  }
  std::vector<Receiver> receivers{receiver_at(place)};
  const std::size_t step = (corners.size() + kMost - 1) / kMost;
  for (std::size_t i = 0; i < corners.size(); i += step) receivers.push_back(corners[i]);
  return receivers;
}

GatherVertex SurfaceClassifier::classify(std::size_t site) const {
  Surrounding around = surrounding_of(site);
  GatherVertex vertex;
  const std::vector<Receiver> receivers = receivers_of(site);
  const auto evaluate = [&](const Sender& sender, int samples) -> std::optional<ClassifiedSender> {
    const Spread spread = spread_of(around, receivers, sender, samples, vertex);
    ClassifiedSender classified = classes_.judge(around, sender, spread, vertex);
    classified.record.form_factor = static_cast<float>(spread.mean);
    return classified;
  };
  const std::vector<std::uint32_t> near = classes_.classify(around, vertex, evaluate);
  if (!near.empty()) add_near(around, near, site, vertex);
  return vertex;
}

Spread SurfaceClassifier::spread_of(const Surrounding& around,
                                    const std::vector<Receiver>& receivers, const Sender& sender,
                                    int count, GatherVertex& vertex) const {
  Spread spread;
  for (const Receiver& receiver : receivers) {
    const Transfer transfer = transfer_.form_factor(receiver, sender.element, count);
    spread.least = std::min(spread.least, transfer.form_factor);
    spread.greatest = std::max(spread.greatest, transfer.form_factor);
    if (&receiver == &receivers.front()) spread.mean = transfer.form_factor;
    vertex.form_factor_samples += static_cast<std::uint64_t>(transfer.form_factor_samples);
  }
  spread.visibility = sender.visibility;
  spread.is_partly_visible = sender.greatest_visibility > 0.0 && sender.least_visibility < 1.0;
  spread.radiosity = transfer_.points().mean_radiosity(sender.element);
  if (visibility_ == VertexVisibility::rays) add_rays(around, sender, count, spread, vertex);
  return spread;
}

void SurfaceClassifier::add_rays(const Surrounding& around, const Sender& sender, int count,
                                 Spread& spread, GatherVertex& vertex) const {
  const auto& tree = surface_.tree();
  const std::uint64_t vertex_key =
      ray_tracing::hash_combine(transfer_.points().key(sender.element), around.leaves.front());
  int traced = 0;
  int seen = 0;
  glm::vec3 light(0.0F);
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    const SenderPoint point = transfer_.points().fixed(sender.element, index);
    const SidePoint& to = point.side;
    const glm::vec4 u =
        ray_tracing::SampleSequence(ray_tracing::SequenceKind::sobol, vertex_key, index).next();
    const SidePoint from = point_on(tree, around.leaves, u);
    const glm::vec3 between = to.surface.position - from.surface.position;
    if (glm::dot(from.normal, between) <= 0.0F || glm::dot(to.normal, between) >= 0.0F) continue;
    ++traced;
    if (tree.rays().is_occluded(segment_to(from.surface, to.surface))) continue;
    ++seen;
    light += point.radiosity;
  }
  vertex.visibility_rays += static_cast<std::uint64_t>(traced);
  if (traced == 0) return;  // no pair faces the other: what links say stands
  spread.visibility = static_cast<double>(seen) / traced;
  spread.is_partly_visible = seen > 0 && seen < traced;
  if (seen > 0) spread.radiosity = light / static_cast<float>(seen);
}

void SurfaceClassifier::add_near(const Surrounding& around,
                                 const std::vector<std::uint32_t>& senders, std::size_t site,
                                 GatherVertex& vertex) const {
  const auto& tree = surface_.tree();
  const TransferSettings& settings = transfer_.settings();
  const int count = classes_.settings().containing_rays;
  const std::uint64_t key = ray_tracing::hash_combine(settings.points.seed, 0x50a7 + site);
  glm::vec3 sum(0.0F);
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    const glm::vec4 u =
        ray_tracing::SampleSequence(ray_tracing::SequenceKind::sobol, key, index).next();
    const SidePoint from = point_on(tree, around.leaves, u);
    const glm::vec3 direction = ray_tracing::frame_around(from.normal)
                                    .to_world(ray_tracing::cosine_hemisphere(
                                        sender_position(settings.points.positions, key, index)));
    ++vertex.visibility_rays;
    // Cosine-distributed: the mean radiosity met is the irradiance.
    sum += radiosity_on(transfer_.solution(), ray_from(from.surface, direction), senders);
  }
  vertex.near_irradiance = sum / static_cast<float>(count);
}

}  // namespace renderers::final_gather

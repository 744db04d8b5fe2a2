#include "renderers/final_gather/link_gather.h"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::final_gather {

using element_hierarchy::Element;
using element_hierarchy::kNoElement;
using element_hierarchy::Link;

bool is_near(const Element& sender, const glm::vec3& place) {
  if (sender.is_patch) return false;
  const glm::vec3 gap =
      glm::max(glm::vec3(0.0F), glm::max(sender.box_min - place, place - sender.box_max));
  return glm::length(gap) < 0.5F * sender.extent_m();
}

glm::vec3 radiosity_on(const element_hierarchy::Solution& solution, const ray_tracing::Ray& ray,
                       const std::vector<std::uint32_t>& senders) {
  ray_tracing::Hit hit;
  if (!solution.tree->rays().intersect(ray, hit)) return glm::vec3(0.0F);
  const std::uint32_t leaf = solution.tree->leaf_at(hit, -ray.direction);
  if (leaf == kNoElement) return glm::vec3(0.0F);
  const std::uint32_t root = solution.tree->at(leaf).root_begin;
  const bool is_sender = std::ranges::any_of(senders, [&](std::uint32_t sender) {
    const Element& element = solution.tree->at(sender);
    return root >= element.root_begin && root < element.root_end;
  });
  return is_sender ? solution.field->radiosity()[leaf] : glm::vec3(0.0F);
}

GatheredLight LinkGather::at(const Receiver& receiver, std::uint32_t leaf) const {
  const element_hierarchy::Solution& solution = transfer_.solution();
  GatheredLight light;
  std::vector<const Link*> far;
  std::vector<std::uint32_t> near;
  double sum = 0.0;
  for (std::uint32_t i = leaf; i != kNoElement; i = solution.tree->at(i).parent) {
    for (const Link& link : solution.links.of(i)) {
      light.senders += 1.0;
      if (link.is(element_hierarchy::fully_occluded)) continue;
      sum += static_cast<double>(element_hierarchy::from_log_code(link.irradiance));
      if (is_near(solution.tree->at(link.source), receiver.point.position)) {
        near.push_back(link.source);
      } else {
        far.push_back(&link);
      }
    }
  }
  std::vector<TransferRequest> requests;
  for (const Link* link : far) {
    const auto irradiance = static_cast<double>(element_hierarchy::from_log_code(link->irradiance));
    if (irradiance <= 0.0) continue;
    requests.push_back({link->source, std::max(1.0, settings_.samples * irradiance / sum)});
  }
  for (const Transfer& transfer : transfer_.whole(receiver, requests)) {
    light.irradiance += transfer.irradiance;
    light.visibility_rays += transfer.visibility_rays;
    light.form_factor_samples += transfer.form_factor_samples;
    light.resampled.z += 1.0;
  }
  if (!near.empty()) add_near(receiver, near, light);
  return light;
}

void LinkGather::add_near(const Receiver& receiver, const std::vector<std::uint32_t>& senders,
                          GatheredLight& light) const {
  const TransferSettings& settings = transfer_.settings();
  const std::uint64_t key = ray_tracing::hash_combine(
      settings.points.seed,
      settings.reuse == Reuse::per_pixel ? receiver.ray_number + 1 : std::uint64_t{0});
  const ray_tracing::Frame3 frame = ray_tracing::frame_around(receiver.normal);
  glm::vec3 sum(0.0F);
  for (int i = 0; i < settings_.near_rays; ++i) {
    const glm::vec2 u =
        sender_position(settings.points.positions, key, static_cast<std::uint32_t>(i));
    const glm::vec3 direction = frame.to_world(ray_tracing::cosine_hemisphere(u));
    if (glm::dot(direction, receiver.normal) <= 0.0F) continue;
    // Cosine-distributed: the mean radiosity met is the irradiance.
    sum += radiosity_on(transfer_.solution(), ray_from(receiver.point, direction), senders);
  }
  light.irradiance += sum / static_cast<float>(settings_.near_rays);
  light.visibility_rays += settings_.near_rays;
  light.resampled.z += 1.0;
}

}  // namespace renderers::final_gather

#include "renderers/many_lights/ray_gather.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/glossy_lobe.h"

namespace renderers::many_lights {

namespace {

using ray_tracing::kPacketRays;
using ray_tracing::Ray;

constexpr float kPi = std::numbers::pi_v<float>;

struct Receiver {
  glm::vec3 position;
  glm::vec3 geometric_normal;
  glm::vec3 shading_normal;
  bool has_lobe = false;
  ray_tracing::SeenLobe glossy;  ///< from the camera
};

/// What one light gives to a receiver if nothing stands between.
struct Contribution {
  glm::vec3 irradiance{0.0F};
  glm::vec3 glossy{0.0F};
};

/// virtual_light.h. @return black if the light cannot reach the receiver
Contribution unshadowed(const Receiver& receiver, const VirtualLight& light, float clamp) {
  Contribution contribution;
  if (light.position.w == 0.0F) return contribution;
  const glm::vec3 to_light = glm::vec3(light.position) - receiver.position;
  const float distance2 = glm::dot(to_light, to_light);
  if (distance2 <= 0.0F) return contribution;
  const glm::vec3 direction = to_light / std::sqrt(distance2);
  const float receiver_cosine = glm::dot(receiver.shading_normal, direction);
  const float light_cosine = -glm::dot(glm::vec3(light.geometric_normal), direction);
  const bool is_above = glm::dot(receiver.geometric_normal, direction) > 0.0F;
  if (receiver_cosine <= 0.0F || light_cosine <= 0.0F || !is_above) return contribution;

  float transfer = receiver_cosine * light_cosine / (kPi * distance2);
  if (clamp > 0.0F) {
    const float geometry = receiver_cosine *
                           std::fabs(glm::dot(glm::vec3(light.shading_normal), direction)) /
                           distance2;
    if (geometry > clamp) transfer *= clamp / geometry;
  }
  contribution.irradiance = transfer * glm::vec3(light.flux);
  if (receiver.has_lobe) {
    contribution.glossy = ray_tracing::lobe_value(receiver.glossy, direction) *
                          receiver.glossy.lobe.albedo * contribution.irradiance;
  }
  return contribution;
}

/// Gathers one image; shared by all threads.
class Gatherer {
 public:
  Gatherer(const RayGatherInput& input, const GatherSettings& settings, GatheredLight& result)
      : input_(input), settings_(settings), result_(result) {
    if (!input.rays || input.rays->triangle_count() == 0) return;
    margin_m_ = input.epsilon * glm::distance(input.rays->box_min(), input.rays->box_max());
    list_members();
  }

  void gather_row(int y);
  std::uint64_t rays() const { return rays_; }
  std::uint64_t occluded() const { return occluded_; }

 private:
  /// Connections of a pixel that wait for their shadow rays.
  struct Packet {
    std::array<Ray, kPacketRays> rays;
    std::array<Contribution, kPacketRays> contributions;
    std::size_t size = 0;
  };
  struct RowCounts {
    std::uint64_t rays = 0;
    std::uint64_t occluded = 0;
  };

  /// The lights of every group, in order.
  void list_members();
  Receiver receiver_at(std::size_t pixel) const;
  /// With groups. @param run  indices of lights
  Contribution gather_groups(const Receiver& receiver, const LightRun& run,
                             RowCounts& counts) const;
  float group_visibility(const Receiver& receiver, std::span<const std::int32_t> members,
                         RowCounts& counts) const;
  Contribution gather(const Receiver& receiver, std::span<const VirtualLight> lights,
                      RowCounts& counts) const;
  /// @return false if the ends are so near that nothing is left of the segment
  bool connect(const Receiver& receiver, const VirtualLight& light, Ray& ray) const;
  void settle(Packet& packet, Contribution& sum, RowCounts& counts) const;

  const RayGatherInput& input_;
  const GatherSettings& settings_;
  GatheredLight& result_;
  float margin_m_ = 0.0F;
  std::vector<std::vector<std::int32_t>> members_;  ///< of each group
  std::atomic<std::uint64_t> rays_ = 0;
  std::atomic<std::uint64_t> occluded_ = 0;
};

void add(const Contribution& contribution, Contribution& sum) {
  sum.irradiance += contribution.irradiance;
  sum.glossy += contribution.glossy;
}

Receiver Gatherer::receiver_at(std::size_t pixel) const {
  const SurfaceImage& surfaces = input_.surfaces;
  Receiver receiver;
  receiver.position = glm::vec3(surfaces.position[pixel]);
  receiver.geometric_normal = glm::vec3(surfaces.geometric_normal[pixel]);
  receiver.shading_normal = glm::vec3(surfaces.shading_normal[pixel]);
  if (settings_.with_glossy && surfaces.albedo[pixel].w > 0.0F) {
    const auto material = static_cast<std::size_t>(surfaces.geometric_normal[pixel].w);
    const glm::vec3 to_camera = glm::normalize(settings_.camera_position - receiver.position);
    receiver.has_lobe = true;
    receiver.glossy = ray_tracing::see_lobe(input_.scene.materials[material].lobe,
                                            receiver.shading_normal, to_camera);
  }
  return receiver;
}

void Gatherer::gather_row(int y) {
  const SurfaceImage& surfaces = input_.surfaces;
  const auto light_count = static_cast<int>(input_.lights.size());
  const auto scale = static_cast<float>(settings_.interleave * settings_.interleave);
  RowCounts counts;
  for (int x = 0; x < surfaces.width_px; ++x) {
    const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(surfaces.width_px) +
                       static_cast<std::size_t>(x);
    if (surfaces.position[pixel].w == 0.0F) continue;
    const LightRun run = light_run(x, y, settings_.interleave, light_count);
    const auto lights = input_.lights.subspan(static_cast<std::size_t>(run.first),
                                              static_cast<std::size_t>(run.count));
    const Contribution sum = members_.empty() ? gather(receiver_at(pixel), lights, counts)
                                              : gather_groups(receiver_at(pixel), run, counts);
    result_.irradiance[pixel] = glm::vec4(scale * sum.irradiance, 1.0F);
    if (settings_.with_glossy) result_.glossy[pixel] = glm::vec4(scale * sum.glossy, 1.0F);
  }
  rays_.fetch_add(counts.rays, std::memory_order_relaxed);
  occluded_.fetch_add(counts.occluded, std::memory_order_relaxed);
}

Contribution Gatherer::gather(const Receiver& receiver, std::span<const VirtualLight> lights,
                              RowCounts& counts) const {
  Contribution sum;
  Packet packet;
  for (const VirtualLight& light : lights) {
    const Contribution contribution = unshadowed(receiver, light, settings_.geometry_clamp);
    if (contribution.irradiance == glm::vec3(0.0F)) continue;
    Ray ray;
    if (!input_.rays || !connect(receiver, light, ray)) {
      add(contribution, sum);
      continue;
    }
    packet.rays[packet.size] = ray;
    packet.contributions[packet.size] = contribution;
    packet.size += 1;
    if (packet.size == kPacketRays) settle(packet, sum, counts);
  }
  if (packet.size > 0) settle(packet, sum, counts);
  return sum;
}

void Gatherer::list_members() {
  for (std::size_t i = 0; i < input_.groups.size(); ++i) {
    if (input_.groups[i] < 0) continue;
    const auto group = static_cast<std::size_t>(input_.groups[i]);
    if (group >= members_.size()) members_.resize(group + 1);
    members_[group].push_back(static_cast<std::int32_t>(i));
  }
}

Contribution Gatherer::gather_groups(const Receiver& receiver, const LightRun& run,
                                     RowCounts& counts) const {
  Contribution sum;
  std::vector<Contribution> groups(members_.size());
  for (int i = run.first; i < run.first + run.count; ++i) {
    const auto light = static_cast<std::size_t>(i);
    if (input_.groups[light] < 0) continue;
    add(unshadowed(receiver, input_.lights[light], settings_.geometry_clamp),
        groups[static_cast<std::size_t>(input_.groups[light])]);
  }
  for (std::size_t group = 0; group < groups.size(); ++group) {
    if (groups[group].irradiance == glm::vec3(0.0F)) continue;
    const float seen = group_visibility(receiver, members_[group], counts);
    add({seen * groups[group].irradiance, seen * groups[group].glossy}, sum);
  }
  return sum;
}

float Gatherer::group_visibility(const Receiver& receiver, std::span<const std::int32_t> members,
                                 RowCounts& counts) const {
  std::array<Ray, kPacketRays> rays;
  std::size_t waiting = 0;
  int lighting = 0;
  int occluded = 0;
  const auto trace = [&] {
    occluded += std::popcount(input_.rays->occluded_mask({rays.data(), waiting}));
    counts.rays += waiting;
    waiting = 0;
  };
  for (const std::int32_t member : members) {
    const VirtualLight& light = input_.lights[static_cast<std::size_t>(member)];
    if (unshadowed(receiver, light, 0.0F).irradiance == glm::vec3(0.0F)) continue;
    ++lighting;
    if (!connect(receiver, light, rays[waiting])) continue;
    if (++waiting == kPacketRays) trace();
  }
  if (waiting > 0) trace();
  counts.occluded += static_cast<std::uint64_t>(occluded);
  return lighting > 0 ? static_cast<float>(lighting - occluded) / static_cast<float>(lighting)
                      : 1.0F;
}

bool Gatherer::connect(const Receiver& receiver, const VirtualLight& light, Ray& ray) const {
  const glm::vec3 from = receiver.position + margin_m_ * receiver.geometric_normal;
  const glm::vec3 to = glm::vec3(light.position) + margin_m_ * glm::vec3(light.geometric_normal);
  const glm::vec3 segment = to - from;
  const float length = glm::length(segment);
  const float left = length - 2.0F * margin_m_;
  if (left <= 0.0F) return false;
  const glm::vec3 direction = segment / length;
  ray = {from + margin_m_ * direction, direction, left};
  return true;
}

void Gatherer::settle(Packet& packet, Contribution& sum, RowCounts& counts) const {
  const std::uint32_t occluded = input_.rays->occluded_mask({packet.rays.data(), packet.size});
  counts.rays += packet.size;
  counts.occluded += static_cast<std::uint64_t>(std::popcount(occluded));
  for (std::size_t i = 0; i < packet.size; ++i) {
    if (((occluded >> i) & 1U) == 0) add(packet.contributions[i], sum);
  }
  packet.size = 0;
}

}  // namespace

GatheredLight gather_by_rays(const RayGatherInput& input, const GatherSettings& settings) {
  assert(settings.interleave >= 1);
  const SurfaceImage& surfaces = input.surfaces;
  GatheredLight result;
  result.irradiance.resize(surfaces.position.size(), glm::vec4(0.0F));
  if (settings.with_glossy) result.glossy.resize(surfaces.position.size(), glm::vec4(0.0F));
  Gatherer gatherer(input, settings, result);
  base::parallel_for(static_cast<std::size_t>(surfaces.height_px), 1,
                     [&](std::size_t begin, std::size_t end) {
                       for (std::size_t y = begin; y < end; ++y) {
                         gatherer.gather_row(static_cast<int>(y));
                       }
                     });
  result.rays = gatherer.rays();
  result.occluded = gatherer.occluded();
  return result;
}

void write_light(const std::shared_ptr<opengl::Context>& context,
                 const opengl::GeometryBuffer& surfaces, const GatheredLight& light,
                 GatherTargets& targets) {
  const opengl::TextureShape shape{.format = opengl::TextureFormat::rgba32f,
                                   .width_px = surfaces.width_px(),
                                   .height_px = surfaces.height_px()};
  const auto write = [&](const std::vector<glm::vec4>& values, opengl::Texture& texture) {
    texture.reshape(context, shape);
    texture.write({values.empty() ? nullptr : &values.front().x, values.size() * 4});
  };
  write(light.irradiance, targets.irradiance);
  if (!light.glossy.empty()) write(light.glossy, targets.glossy);
}

}  // namespace renderers::many_lights

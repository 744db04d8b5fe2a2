#include "renderers/ray_bundles/glossy_transfer.h"

#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/glossy_lobe.h"

namespace renderers::ray_bundles {

namespace {

float sign_of(std::uint32_t side) { return side % 2 == 0 ? 1.0F : -1.0F; }

}  // namespace

GlossyTransfer::GlossyTransfer(const ray_tracing::RayScene& rays,
                               const texel_atlas::TexelAtlas& atlas, bool has_back_sides)
    : has_back_sides_(has_back_sides), lobe_of_(atlas.texels().size(), kNoLobe) {
  const ray_tracing::LightSampler lights(rays, ray_tracing::LightSet::hittable);
  for (std::uint32_t i = 0; i < atlas.texels().size(); ++i) {
    const ray_tracing::SurfacePoint& point = atlas.texels()[i].point;
    const scene::Material& material =
        rays.scene().materials[static_cast<std::size_t>(point.material)];
    if (!material.is_glossy()) continue;
    lobe_of_[i] = static_cast<std::uint32_t>(lobes_.size());
    lobes_.push_back({i, point.geometric_normal, point.shading_normal, material.lobe, {}});
    find_known_light(rays, lights, point);
  }
  sent_.resize(2 * lobes_.size());
  next_sent_.resize(2 * lobes_.size());
}

/// Of the lobe added last. @param point  of its texel
void GlossyTransfer::find_known_light(const ray_tracing::RayScene& rays,
                                      const ray_tracing::LightSampler& lights,
                                      const ray_tracing::SurfacePoint& point) {
  for (const scene::Light& light : rays.scene().lights) {
    const auto sample = lights.sample_point_light(light, point);
    if (!sample) continue;
    const std::uint32_t side = glm::dot(point.geometric_normal, sample->direction) > 0.0F ? 0U : 1U;
    const float cosine = sign_of(side) * glm::dot(point.shading_normal, sample->direction);
    if (cosine <= 0.0F || (side == 1 && !has_back_sides_)) continue;
    ++shadow_rays_;
    if (rays.is_occluded(sample->shadow_ray)) continue;
    lobes_.back().known.push_back({side, sample->direction, cosine * sample->radiance});
  }
}

void GlossyTransfer::begin_direction(const glm::vec3& direction, const glm::vec3& next) {
  direction_ = direction;
  next_ = next;
}

/// f of the lobe, 1/sr, from a direction towards the next bundle.
glm::vec3 GlossyTransfer::lobe_value(const Lobe& lobe, std::uint32_t side,
                                     const glm::vec3& to_light) const {
  const float sign = sign_of(side);
  // The sense of the next direction that leaves this side, and its mirror direction.
  const bool leaves_ahead = sign * glm::dot(lobe.geometric_normal, next_) > 0.0F;
  const glm::vec3 out = leaves_ahead ? next_ : -next_;
  const glm::vec3 normal = sign * lobe.shading_normal;
  if (glm::dot(normal, out) <= 0.0F) return glm::vec3(0.0F);
  return lobe.shape.albedo *
         ray_tracing::lobe_value(ray_tracing::see_lobe(lobe.shape, normal, out), to_light);
}

void GlossyTransfer::receive(std::uint32_t texel, const TexelSample& sample) {
  const std::uint32_t index = lobe_of_[texel];
  if (index == kNoLobe) return;
  const Lobe& lobe = lobes_[index];
  for (std::uint32_t side = 0; side < (has_back_sides_ ? 2U : 1U); ++side) {
    const bool comes_from_ahead =
        sign_of(side) * glm::dot(lobe.geometric_normal, direction_) > 0.0F;
    const glm::vec3 to_light = comes_from_ahead ? direction_ : -direction_;
    const TexelSample::SideLight& light = sample.sides[side];
    // Eq. 4; |n . w| is in the sample.
    next_sent_[2 * index + side] = 2.0F * ray_tracing::kPi * lobe_value(lobe, side, to_light) *
                                   (light.emitted + light.reflected);
  }
  for (const KnownLight& known : lobe.known) {
    next_sent_[2 * index + known.side] +=
        lobe_value(lobe, known.side, known.direction) * known.irradiance;
  }
}

void GlossyTransfer::end_direction() { std::swap(sent_, next_sent_); }

void GlossyTransfer::add_to(std::vector<glm::vec3>& sent) const {
  for (std::size_t i = 0; i < lobes_.size(); ++i) {
    const std::size_t side = 2 * static_cast<std::size_t>(lobes_[i].texel);
    sent[side] += sent_[2 * i];
    sent[side + 1] += sent_[2 * i + 1];
  }
}

glm::vec3 GlossyTransfer::radiance(std::uint32_t side) const {
  const std::uint32_t index = lobe_of_[side / 2];
  return index == kNoLobe ? glm::vec3(0.0F) : sent_[2 * index + side % 2];
}

}  // namespace renderers::ray_bundles

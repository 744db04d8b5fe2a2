#include "renderers/ray_bundles/directed_emission.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "renderers/scene/emission_profile.h"

namespace renderers::ray_bundles {

DirectedEmission::DirectedEmission(const ray_tracing::RayScene& rays,
                                   const texel_atlas::TexelAtlas& atlas)
    : rays_(rays), atlas_(atlas), factors_(atlas.texels().size(), 1.0F) {
  for (std::uint32_t texel = 0; texel < factors_.size(); ++texel) {
    const std::vector<float>& profile = profile_of(texel);
    if (profile.empty()) continue;
    beams_.push_back(texel);
    factors_[texel] = static_cast<float>(scene::flux_factor(profile));
  }
}

const std::vector<float>& DirectedEmission::profile_of(std::uint32_t texel) const {
  const auto material = static_cast<std::size_t>(atlas_.texels()[texel].point.material);
  return rays_.scene().materials[material].emission_profile;
}

void DirectedEmission::turn(const glm::vec3& direction) {
  for (const std::uint32_t texel : beams_) {
    const float cosine = glm::dot(atlas_.texels()[texel].point.geometric_normal, direction);
    factors_[texel] = scene::emission_factor(profile_of(texel), std::fabs(cosine));
  }
}

void DirectedEmission::apply(LightSolution& solution) const {
  for (const std::uint32_t texel : beams_) {
    solution.set_emitted(texel, factors_[texel] * atlas_.texels()[texel].emission);
  }
}

std::int64_t DirectedEmission::memory_bytes() const {
  return static_cast<std::int64_t>(beams_.size() * sizeof(std::uint32_t) +
                                   factors_.size() * sizeof(float));
}

}  // namespace renderers::ray_bundles

#include "renderers/ray_bundles/path_census.h"

#include <cassert>

#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::ray_bundles {

PathCensus::PathCensus(const texel_atlas::TexelAtlas& atlas, const SolutionSettings& settings,
                       int most)
    : atlas_(atlas), sent_(2 * atlas.texels().size()) {
  assert(settings.feed != FeedKind::jacobi && !settings.glossy_chain && most >= 1);
  SolutionSettings one = settings;
  one.carries_emission = false;
  for (int k = 0; k < most; ++k) lengths_.emplace_back(atlas, one);
}

void PathCensus::send(std::size_t k, const LightSolution& counted) {
  for (std::uint32_t side = 0; side < sent_.size(); ++side) {
    const glm::vec3 incident = k == 0 ? counted.direct(side) : lengths_[k - 1].feed(side);
    sent_[side] = atlas_.texels()[side / 2].albedo * incident;
  }
  lengths_[k].set_sent(sent_);
}

std::vector<double> PathCensus::means(const LightSolution& counted) const {
  std::vector<double> means(lengths_.size() + 1, 0.0);
  double area_m2 = 0.0;
  for (std::uint32_t side = 0; side < sent_.size(); ++side) {
    const auto weight = static_cast<double>(atlas_.texels()[side / 2].area_m2);
    if (side % 2 == 0) area_m2 += weight;
    const auto add = [&](std::size_t length, const glm::vec3& incident) {
      means[length] += weight * static_cast<double>(ray_tracing::luminance(incident));
    };
    add(0, counted.direct(side));
    for (std::size_t k = 0; k < lengths_.size(); ++k) add(k + 1, lengths_[k].indirect(side));
  }
  for (double& mean : means) mean = area_m2 > 0.0 ? mean / area_m2 : 0.0;
  return means;
}

std::int64_t PathCensus::memory_bytes() const {
  std::int64_t bytes = static_cast<std::int64_t>(sent_.size() * sizeof(glm::vec3));
  for (const LightSolution& length : lengths_) bytes += length.memory_bytes();
  return bytes;
}

}  // namespace renderers::ray_bundles

#include "renderers/clustered_visibility/oracle_gather.h"

#include <cassert>
#include <cstddef>
#include <vector>

namespace renderers::clustered_visibility {

namespace {

using many_lights::VirtualLight;

void add(const std::vector<glm::vec4>& added, std::vector<glm::vec4>& sum) {
  assert(added.size() == sum.size());
  // w says whether there is a surface, in both alike.
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] = glm::vec4(glm::vec3(sum[i]) + glm::vec3(added[i]), sum[i].w);
  }
}

}  // namespace

many_lights::GatheredLight gather_by_oracle(const OracleReceivers& receivers, const LightSet& set,
                                            int light_count,
                                            const many_lights::GatherSettings& settings,
                                            StageTimer& timer) {
  std::vector<VirtualLight> lights;
  std::vector<std::int32_t> clusters;
  {
    const auto transfer = timer.stage("transfer");
    lights = set.lights->read<VirtualLight>(static_cast<std::size_t>(light_count));
    clusters = set.clusters->clusters().read_assignments();
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (set.only < 0 || clusters[i] == set.only) continue;
    lights[i] = {};
    clusters[i] = -1;
  }
  return many_lights::gather_by_rays({.scene = receivers.scene,
                                      .surfaces = receivers.surfaces,
                                      .lights = lights,
                                      .rays = &receivers.rays,
                                      .groups = clusters},
                                     settings);
}

void add_light(const many_lights::GatheredLight& added, many_lights::GatheredLight& sum) {
  add(added.irradiance, sum.irradiance);
  add(added.glossy, sum.glossy);
  sum.rays += added.rays;
  sum.occluded += added.occluded;
}

}  // namespace renderers::clustered_visibility

#include "renderers/area_shadows/gpu_visibility.h"

#include <cassert>
#include <limits>

#include "renderers/opengl/gpu_stage.h"

namespace renderers::area_shadows {

using gpu_tracing::Fan;
using gpu_tracing::kFanTargets;

static_assert(kFanTargets == ray_tracing::kGroupPoints);

GpuVisibility::GpuVisibility(DeviceRays& gpu, const PixelSurfaces& surfaces,
                             const std::vector<ray_tracing::LightPointSet>& lights,
                             StageTimer& timer)
    : gpu_(gpu), surfaces_(surfaces) {
  std::vector<glm::vec4> targets;
  for (const ray_tracing::LightPointSet& light : lights) {
    first_fans_.push_back(static_cast<std::uint32_t>(targets.size() / kFanTargets));
    const float end =
        light.is_environment ? std::numeric_limits<float>::infinity() : ray_tracing::kSegmentEnd;
    for (std::size_t group = 0; group < light.group_count(); ++group) {
      for (const ray_tracing::LightPoint& point : light.group(group)) {
        targets.emplace_back(point.target, end);
      }
      targets.resize((first_fans_.back() + group + 1) * kFanTargets);
    }
  }
  opengl::GpuStage stage(*gpu_.bvh.context(), timer, "upload");
  gpu_.tracer.set_targets(targets);
  stage.add_bytes(0, static_cast<std::int64_t>(targets.size() * sizeof(glm::vec4)));
}

void GpuVisibility::find(std::span<const GroupRays> rays, std::span<std::uint16_t> visible,
                         StageTimer& timer) {
  assert(rays.size() == visible.size());
  std::vector<Fan> fans;
  std::vector<std::uint32_t> places;  // of the fans in the list
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    visible[i] = 0;
    if (rays[i].facing == 0) continue;
    const glm::vec3& origin = surfaces_.pixels[rays[i].pixel].receiver.origin;
    const std::uint32_t row = first_fans_[rays[i].light] + rays[i].group;
    fans.push_back({{origin.x, origin.y, origin.z},
                    row * static_cast<std::uint32_t>(kFanTargets),
                    rays[i].facing});
    places.push_back(i);
  }
  const std::vector<std::uint32_t> occluded = gpu_.tracer.occluded(gpu_.bvh, fans, timer);
  for (std::size_t k = 0; k < places.size(); ++k) {
    visible[places[k]] = static_cast<std::uint16_t>(fans[k].asked & ~occluded[k]);
  }
}

}  // namespace renderers::area_shadows

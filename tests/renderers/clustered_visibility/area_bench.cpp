#include "tests/renderers/clustered_visibility/area_bench.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "renderers/clustered_visibility/far_depth.h"
#include "renderers/shadow_maps/hard_maps.h"
#include "tests/renderers/many_lights/gl_fixture.h"

namespace test_clustered_visibility {

namespace opengl = renderers::opengl;

AreaBench::AreaBench(std::shared_ptr<opengl::Context> context, const renderers::scene::Scene& scene,
                     const cv::AreaLight& area, int map_px)
    : context_(std::move(context)),
      area_(area),
      lights_(opengl::Buffer::of<cv::AreaLight>(context_, std::array{area})),
      maps_(context_, map_px, 1) {
  opengl::GpuScene gpu_scene(context_);
  renderers::StageTimer timer;
  gpu_scene.load(scene, timer);
  renderers::shadow_maps::HardMaps(context_).fill(maps_, gpu_scene,
                                                  {&lights_, cv::kAreaLightStride}, 0, 1);
}

std::vector<double> AreaBench::visibility(const renderers::many_lights::SurfaceImage& surfaces,
                                          const cv::AreaVisibilitySettings& settings,
                                          const cv::ConvolutionSettings& convolution) const {
  std::optional<cv::ConvolutionMaps> filtered;
  std::optional<cv::MomentMaps> moments;
  if (settings.test == cv::AreaTest::cssm) {
    filtered.emplace(context_, maps_.size_px(), 1, convolution);
    filtered->make(maps_, lights_);
  }
  if (settings.test == cv::AreaTest::msm) {
    moments.emplace(context_, maps_.size_px(), 1);
    moments->make(maps_, lights_);
  }
  const auto geometry = renderers::test::geometry_of(context_, surfaces);
  const opengl::Texture shown(
      context_, {.width_px = geometry->width_px(), .height_px = geometry->height_px()});
  show_visibility(*geometry, 0, settings,
                  {lights_, maps_, filtered ? &*filtered : nullptr, moments ? &*moments : nullptr},
                  shown);
  std::vector<double> values;
  for (const glm::vec3& each : renderers::test::read_rgb(shown)) values.push_back(double{each.x});
  return values;
}

std::optional<double> AreaBench::oracle_visibility(const AreaVisibilityOracle& oracle,
                                                   const glm::vec3& position,
                                                   const glm::vec3& normal) const {
  return oracle.visibility(area_, seen_from(area_, maps_.near_m(), position, normal));
}

DepthMap AreaBench::depth_map() const {
  DepthMap map{maps_.size_px(), {}};
  for (const std::uint32_t word : maps_.distances().read_words()) {
    const double distance_m = double{std::bit_cast<float>(word)};
    map.z.push_back(std::min(distance_m * double{area_.shape.y}, double{cv::kFarDepth}));
  }
  return map;
}

cv::AreaLight light_above(const glm::vec3& position, float size_m, float farthest_m) {
  cv::AreaLight area;
  area.position = glm::vec4(position, 1.0F);
  area.axis = {0.0F, -1.0F, 0.0F, 0.0F};
  area.shape = {size_m, cv::kFarDepth / farthest_m, size_m * size_m, 1.0F};
  return area;
}

}  // namespace test_clustered_visibility

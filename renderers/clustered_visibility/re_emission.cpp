#include "renderers/clustered_visibility/re_emission.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec4.hpp>

#include "renderers/clustered_visibility/shader_files.h"
#include "renderers/many_lights/virtual_light.h"
#include "renderers/opengl/program.h"

namespace renderers::clustered_visibility {

namespace {

using many_lights::VirtualLight;

constexpr int kLocalSize = 64;  ///< of place_receivers and re_emit
constexpr std::uint32_t kLightsBinding = 3;
constexpr std::uint32_t kPointsBinding = 4;
/// The sides' draws are multiples of the golden ratio, modulo 1: any run of them is spread.
constexpr double kGolden = 0.61803398874989484820;

/// std430, placed_point.glsl.
struct PlacedPoint {
  glm::vec4 position{0.0F};
  glm::ivec4 where{0};
};

opengl::Program& program_of(opengl::Context& context, const char* pass) {
  return context.program(
      {shader_files(),
       {std::string("renderers/clustered_visibility/shaders/") + pass + ".comp.glsl"}});
}

/// Texels in a row: a power of two, so that two sides of N points fit about a square.
int row_px(int lights) {
  const double side = std::sqrt(2.0 * lights);
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(side))));
}

int rows_px(int lights) {
  const int width_px = row_px(lights);
  return (2 * lights + width_px - 1) / width_px;
}

std::vector<PlacedPoint> placed(const std::vector<shadow_maps::SurfacePoint>& points) {
  std::vector<PlacedPoint> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double turns = (static_cast<double>(i) + 0.5) * kGolden;
    const auto draw = static_cast<float>(turns - std::floor(turns));
    result.push_back(
        {glm::vec4(points[i].position, draw), {points[i].triangle, points[i].place, 0, 0}});
  }
  return result;
}

}  // namespace

ReEmission::ReEmission(std::shared_ptr<opengl::Context> context, int lights)
    : context_(std::move(context)),
      light_count_(lights),
      receivers_(context_, row_px(lights), rows_px(lights)),
      points_(context_, static_cast<std::size_t>(lights) * sizeof(PlacedPoint)),
      lights_(context_, static_cast<std::size_t>(lights) * sizeof(VirtualLight)) {}

void ReEmission::place(const shadow_maps::SurfacePoints& points, const opengl::GpuScene& scene) {
  point_count_ = static_cast<int>(points.points.size());
  assert(point_count_ == light_count_ || point_count_ == 0);
  point_area_m2_ = static_cast<float>(points.area_m2 / light_count_);
  points_.write(std::span<const PlacedPoint>(placed(points.points)));
  opengl::Program& program = program_of(*context_, "place_receivers");
  program.storage(0, scene.triangles());
  program.storage(1, scene.materials());
  program.storage(2, scene.texels());
  program.storage(kPointsBinding, points_);
  const opengl::Texture* maps[]{&receivers_.position(), &receivers_.geometric_normal(),
                                &receivers_.shading_normal(), &receivers_.albedo()};
  for (std::uint32_t i = 0; i < 4; ++i) program.image(i, *maps[i], opengl::Access::write);
  program.set("point_count", point_count_);
  program.set("width_px", receivers_.width_px());
  const int texels = receivers_.width_px() * receivers_.height_px();
  program.dispatch(opengl::groups_for(texels, kLocalSize));
}

void ReEmission::emit(const opengl::Texture& irradiance) {
  if (point_count_ == 0) {
    lights_.fill(0);
    return;
  }
  assert(irradiance.shape().width_px == receivers_.width_px());
  opengl::Program& program = program_of(*context_, "re_emit");
  program.storage(kLightsBinding, lights_);
  program.storage(kPointsBinding, points_);
  program.sampler(0, receivers_.position());
  program.sampler(1, receivers_.geometric_normal());
  program.sampler(2, receivers_.shading_normal());
  program.sampler(3, receivers_.albedo());
  program.sampler(4, irradiance);
  program.set("point_count", point_count_);
  program.set("width_px", receivers_.width_px());
  program.set("point_area", point_area_m2_);
  program.dispatch(opengl::groups_for(point_count_, kLocalSize));
  context_->check("re-emitting light");
}

std::int64_t ReEmission::memory_bytes() const {
  return receivers_.memory_bytes() +
         static_cast<std::int64_t>(points_.size_bytes() + lights_.size_bytes());
}

}  // namespace renderers::clustered_visibility

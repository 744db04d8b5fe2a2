#include "renderers/shadow_maps/triangle_spheres.h"

#include "renderers/opengl/program.h"
#include "renderers/shadow_maps/shader_files.h"

namespace renderers::shadow_maps {

namespace {

constexpr int kLocalSize = 64;
constexpr std::uint32_t kSphereBinding = 4;

}  // namespace

void TriangleSpheres::load(const opengl::GpuScene& scene) {
  const int triangles = scene.triangle_count();
  spheres_.reserve(scene.context(), static_cast<std::size_t>(triangles) * 4 * sizeof(float));
  opengl::Program& program = scene.context()->program(
      {shader_files(), {"renderers/shadow_maps/shaders/triangle_spheres.comp.glsl"}});
  program.storage(0, scene.triangles());
  program.storage(kSphereBinding, spheres_);
  program.set("triangle_count", triangles);
  program.dispatch(opengl::groups_for(triangles, kLocalSize));
}

}  // namespace renderers::shadow_maps

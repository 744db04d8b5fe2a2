#include "renderers/many_lights/shade.h"

#include <cassert>
#include <utility>

#include "renderers/many_lights/shader_files.h"
#include "renderers/opengl/program.h"

namespace renderers::many_lights {

namespace {

constexpr int kLocalSize = 8;  ///< of shade.comp.glsl

}  // namespace

Shade::Shade(std::shared_ptr<opengl::Context> context) : context_(std::move(context)) {}

void Shade::begin(int width_px, int height_px) {
  sum_.reshape(
      context_,
      {.format = opengl::TextureFormat::rgba32f, .width_px = width_px, .height_px = height_px});
  sum_.clear({0.0F, 0.0F, 0.0F, 0.0F});
}

void Shade::add(const opengl::GeometryBuffer& surfaces, const GatherTargets& light,
                bool with_glossy, float weight) {
  const int width_px = surfaces.width_px();
  const int height_px = surfaces.height_px();
  assert(sum_.shape().width_px == width_px && sum_.shape().height_px == height_px);
  opengl::ProgramSource source{shader_files(), {"renderers/many_lights/shaders/shade.comp.glsl"}};
  if (with_glossy) source.defines.emplace_back("WITH_GLOSSY", "1");
  opengl::Program& program = context_->program(source);
  program.sampler(0, surfaces.position());
  program.sampler(1, surfaces.albedo());
  program.sampler(2, light.irradiance);
  if (with_glossy) program.sampler(3, light.glossy);
  program.image(0, sum_, opengl::Access::read_write);
  program.set("size_px", glm::ivec2(width_px, height_px));
  program.set("weight", weight);
  program.dispatch(opengl::groups_for(width_px, kLocalSize),
                   opengl::groups_for(height_px, kLocalSize));
}

}  // namespace renderers::many_lights

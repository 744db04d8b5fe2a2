#include "renderers/many_lights/geometry_aware_blur.h"

#include <cassert>
#include <string>
#include <utility>

#include "renderers/many_lights/shader_files.h"
#include "renderers/opengl/program.h"

namespace renderers::many_lights {

namespace {

constexpr int kRun = 8;  ///< of blur.comp.glsl: pixels of a thread
/// Threads of a group, along and across the pass's axis.
constexpr int kLocalAlong = 4;
constexpr int kLocalAcross = 16;

opengl::TextureShape shape_of(const opengl::GeometryBuffer& surfaces) {
  return {.format = opengl::TextureFormat::rgba32f,
          .width_px = surfaces.width_px(),
          .height_px = surfaces.height_px()};
}

}  // namespace

/// Taps of a pass, in pixels on both sides of the pixel.
struct GeometryAwareBlur::Window {
  int before = 0;
  int after = 0;
  int rows_before = 0;
  int rows_after = 0;
  bool has_half_ends = false;
  glm::ivec2 axis{1, 0};
};

GeometryAwareBlur::GeometryAwareBlur(std::shared_ptr<opengl::Context> context)
    : context_(std::move(context)) {}

void GeometryAwareBlur::apply(const opengl::GeometryBuffer& surfaces, const BlurSettings& settings,
                              opengl::Texture& values) {
  assert(values.shape() == shape_of(surfaces) && settings.alpha_m >= 0.0F);
  const int n = settings.interleave;
  if (n == 1) return;
  rows_.reshape(context_, shape_of(surfaces));
  Window window{.before = n / 2, .after = (n - 1) / 2};
  if (settings.kind == BlurKind::box) {
    window.rows_before = window.before;
    window.rows_after = window.after;
    run(surfaces, settings, window, values, rows_);
    std::swap(rows_, values);
    return;
  }
  if (settings.kind == BlurKind::centred && n % 2 == 0) {
    window.after = window.before;
    window.has_half_ends = true;
  }
  run(surfaces, settings, window, values, rows_);
  window.axis = {0, 1};
  run(surfaces, settings, window, rows_, values);
}

void GeometryAwareBlur::run(const opengl::GeometryBuffer& surfaces, const BlurSettings& settings,
                            const Window& window, const opengl::Texture& from,
                            const opengl::Texture& to) {
  const bool is_along_x = window.axis.x == 1;
  opengl::ProgramSource source{shader_files(), {"renderers/many_lights/shaders/blur.comp.glsl"}};
  source.defines = {{"LOCAL_X", std::to_string(is_along_x ? kLocalAlong : kLocalAcross)},
                    {"LOCAL_Y", std::to_string(is_along_x ? kLocalAcross : kLocalAlong)},
                    {"BEFORE", std::to_string(window.before)},
                    {"AFTER", std::to_string(window.after)},
                    {"ROWS_BEFORE", std::to_string(window.rows_before)},
                    {"ROWS_AFTER", std::to_string(window.rows_after)}};
  if (window.has_half_ends) source.defines.emplace_back("HALF_ENDS", "1");
  opengl::Program& program = context_->program(source);
  program.sampler(0, surfaces.position());
  program.sampler(1, surfaces.shading_normal());
  program.sampler(2, from);
  program.image(0, to, opengl::Access::write);
  const glm::ivec2 size_px(surfaces.width_px(), surfaces.height_px());
  program.set("size_px", size_px);
  program.set("axis", window.axis);
  program.set("alpha2", settings.alpha_m * settings.alpha_m);
  program.set("beta", settings.beta);
  const int along = kLocalAlong * kRun;
  program.dispatch(opengl::groups_for(size_px.x, is_along_x ? along : kLocalAcross),
                   opengl::groups_for(size_px.y, is_along_x ? kLocalAcross : along));
}

std::int64_t GeometryAwareBlur::memory_bytes() const {
  return rows_.is_empty() ? 0 : opengl::size_bytes_of(rows_.shape());
}

}  // namespace renderers::many_lights

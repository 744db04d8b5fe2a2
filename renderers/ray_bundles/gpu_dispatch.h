#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "renderers/opengl/program.h"
#include "renderers/opengl/shader_source.h"
#include "renderers/ray_bundles/bundle_frame.h"
#include "renderers/ray_bundles/shader_files.h"

namespace renderers::ray_bundles {

/// A thread for each of so many items (`thread_index` of shaders/thread_index.glsl), in work groups
/// of 64. Rows of groups, as devices bound what stands along an axis.
inline void dispatch_items(opengl::Program& program, std::int64_t items) {
  constexpr std::int64_t kLocalSize = 64;
  constexpr std::uint32_t kMostAcross = 16384;
  const std::uint32_t groups = opengl::groups_for(std::max<std::int64_t>(items, 1), kLocalSize);
  const std::uint32_t across = std::min(groups, kMostAcross);
  program.dispatch(across, opengl::groups_for(groups, across));
}

/// A shader of this folder. @param pass  "bundle_planes.comp"
inline std::string shader_path(const std::string& pass) {
  return "renderers/ray_bundles/shaders/" + pass + ".glsl";
}

/// A compute program of this folder.
inline opengl::Program& compute_program(opengl::Context& context, const std::string& pass,
                                        opengl::Defines defines = {}) {
  return context.program({shader_files(), {shader_path(pass + ".comp")}, std::move(defines)});
}

/// The uniform of shaders/loop_probe.glsl.
inline void set_loop_probe(opengl::Program& program) { program.set("probe_turns", 2U); }

/// The uniforms of shaders/bundle_frame.glsl.
inline void set_frame(opengl::Program& program, const BundleFrame& frame) {
  program.set("axis_x", frame.axis_x);
  program.set("axis_y", frame.axis_y);
  program.set("direction", frame.direction);
  program.set("corner", frame.corner);
  program.set("pixel_m", frame.pixel_m);
}

}  // namespace renderers::ray_bundles

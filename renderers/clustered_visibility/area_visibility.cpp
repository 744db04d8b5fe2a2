#include "renderers/clustered_visibility/area_visibility.h"

#include <cassert>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "renderers/clustered_visibility/loop_turns.h"
#include "renderers/clustered_visibility/shader_files.h"
#include "renderers/opengl/program.h"

namespace renderers::clustered_visibility {

namespace {

constexpr std::uint32_t kAreaLights = 7;
constexpr int kLocalSide = 8;      ///< of show_visibility
constexpr int kTableCorners = 16;  ///< that the sum over a box is made of
constexpr int kPcfTurns = 512;  ///< of loops, for two kernels of kMostSteps^2 (closer_filter.glsl)

/// w_k = 2 / c_k exp(-a (k / K)^2), c_k = pi (2k - 1), as GLSL: vec4[n](vec4(...), ...).
std::string series_weights(int terms, float damping) {
  const int groups = (terms + 3) / 4;
  std::string text = fmt::format("vec4[{}](", groups);
  for (int k = 1; k <= 4 * groups; ++k) {
    const double share = static_cast<double>(k) / terms;
    const double weight =
        2.0 / (std::numbers::pi * (2 * k - 1)) * std::exp(-damping * share * share);
    text += fmt::format("{}{:.9e}{}", k % 4 == 1 ? "vec4(" : ", ", k <= terms ? weight : 0.0,
                        k % 4 != 0       ? ""
                        : k < 4 * groups ? "), "
                                         : ")");
  }
  return text + ")";
}

}  // namespace

opengl::Defines area_visibility_defines(const AreaVisibilitySettings& settings,
                                        const ConvolutionMaps* filtered) {
  opengl::Defines defines;
  if (settings.test == AreaTest::hard) defines.emplace_back("VISIBILITY_HARD", "1");
  if (settings.test == AreaTest::pcf) defines.emplace_back("VISIBILITY_PCF", "1");
  if (settings.kernel == KernelWidth::conformal) defines.emplace_back("KERNEL_CONFORMAL", "1");
  if (settings.is_foreshortened) defines.emplace_back("FORESHORTENED", "1");
  if (settings.test == AreaTest::msm) {
    defines.emplace_back("VISIBILITY_MOMENTS", "1");
    defines.emplace_back("MOMENT_TAPS", std::to_string(settings.moments.taps));
  }
  if (settings.test != AreaTest::cssm) return defines;
  assert(filtered != nullptr);
  const int terms = filtered->settings().terms;
  defines.emplace_back("TERMS", std::to_string(terms));
  defines.emplace_back("GROUPS", std::to_string((terms + 3) / 4));
  defines.emplace_back("SERIES_WEIGHTS", series_weights(terms, settings.damping));
  if (settings.fix == LitFix::offset) defines.emplace_back("FIX_OFFSET", "1");
  if (settings.blocker == BlockerDepth::corrected) defines.emplace_back("BLOCKER_CORRECTED", "1");
  if (filtered->settings().prefilter == Prefilter::sat) {
    defines.emplace_back("PREFILTER_SAT", "1");
    defines.emplace_back("TABLE_SCALE", std::to_string(filtered->table_scale()));
  }
  return defines;
}

void bind_area_visibility(opengl::Program& program, const AreaVisibilitySettings& settings,
                          const AreaShadows& shadows) {
  shadow_maps::bind_hemisphere_maps(program, shadows.maps, {});
  program.storage(kAreaLights, shadows.area_lights);
  if (settings.test == AreaTest::hard) return;
  program.set("search_scale", settings.search_scale);
  if (settings.test == AreaTest::pcf) return;
  if (settings.test == AreaTest::msm) {
    shadows.moments->bind(program);
    program.set("moment_finer_levels", settings.moments.finer_levels);
    program.set("moment_slope", settings.moments.slope);
    program.set("moment_bias", settings.moments.bias);
    program.set("blocked_bias", settings.moments.blocked_bias);
    return;
  }
  shadows.filtered->bind(program);
  program.set("slope_bias", settings.slope_bias);
  if (shadows.filtered->settings().prefilter == Prefilter::mip) {
    program.set("finer_levels", settings.finer_levels);
  } else {
    program.set("table_corners", kTableCorners);
  }
  program.set("contact_strength", settings.contact_strength);
  program.set("contact_range", settings.contact_range);
}

std::optional<int> most_lights_at_once(const AreaVisibilitySettings& settings,
                                       const ConvolutionMaps* filtered) {
  if (settings.test == AreaTest::pcf) return kMostTurns / kPcfTurns;
  if (settings.test != AreaTest::cssm || filtered->settings().prefilter == Prefilter::mip) {
    return std::nullopt;
  }
  const int groups = (filtered->settings().terms + 3) / 4;
  return kMostTurns / (kTableCorners * (6 * groups + 1));
}

many_lights::GatherVisibility gather_visibility(const AreaVisibilitySettings& settings,
                                                const AreaShadows& shadows) {
  many_lights::GatherVisibility visibility;
  visibility.files = shader_files();
  visibility.shader = "renderers/clustered_visibility/shaders/gather_clusters.comp.glsl";
  visibility.defines = area_visibility_defines(settings, shadows.filtered);
  visibility.defines.emplace_back("WITH_VISIBILITY", "1");
  visibility.defines.emplace_back("WITH_GROUPS", "1");
  visibility.is_costly = most_lights_at_once(settings, shadows.filtered).has_value();
  visibility.bind = [settings, shadows](opengl::Program& program) {
    bind_area_visibility(program, settings, shadows);
  };
  return visibility;
}

void show_visibility(const opengl::GeometryBuffer& surfaces, int cluster,
                     const AreaVisibilitySettings& settings, const AreaShadows& shadows,
                     const opengl::Texture& shown) {
  opengl::Program& program = surfaces.context()->program(
      {shader_files(),
       {"renderers/clustered_visibility/shaders/show_visibility.comp.glsl"},
       area_visibility_defines(settings, shadows.filtered)});
  bind_area_visibility(program, settings, shadows);
  program.sampler(0, surfaces.position());
  program.sampler(1, surfaces.geometric_normal());
  program.image(0, shown, opengl::Access::write);
  program.set("cluster", cluster);
  program.dispatch(opengl::groups_for(surfaces.width_px(), kLocalSide),
                   opengl::groups_for(surfaces.height_px(), kLocalSide));
}

}  // namespace renderers::clustered_visibility

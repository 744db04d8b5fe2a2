#pragma once

#include <optional>

#include "renderers/clustered_visibility/convolution_maps.h"
#include "renderers/clustered_visibility/moment_maps.h"
#include "renderers/many_lights/gather.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/shader_source.h"
#include "renderers/shadow_maps/hemisphere_maps.h"

namespace renderers::clustered_visibility {

/// How the share of an area light that a receiver sees is found.
enum class AreaTest {
  hard,  ///< one comparison in the light's map
  pcf,   ///< percentage-closer soft shadows, texel by texel
  cssm,  ///< convolution soft shadow maps
  msm    ///< moment soft shadow maps; ours
};

/// What makes a receiver at a blocker's depth lit, which the series gives 1/2.
enum class LitFix { scale, offset };
/// Width of an angle in the map: Dong et al. 2009, Sec. 4.2 (alpha / pi), or that of the
/// projection.
enum class KernelWidth { paper, conformal };
/// Mean depth of blockers: as printed, or without the share of what is not before the receiver.
enum class BlockerDepth { raw, corrected };

/// Of moment soft shadow maps; shaders/moment_filter.glsl. All ours.
struct MomentSettings {
  int taps = 1;                ///< boxes along a side that a kernel is made of, 1 to 4
  float finer_levels = 1.25F;  ///< than the one as wide as such a box
  float slope = 1.3F;          ///< of the receiver's rise within a kernel, what counts as its own
  float bias = 3e-7F;          ///< share of the moments of an even spread, against rounding
  float blocked_bias = 0.01F;  ///< share of blockers taken to lie at the receiver
};

/// Shaders and formulas: shaders/area_visibility.glsl and those it includes.
struct AreaVisibilitySettings {
  AreaTest test = AreaTest::cssm;
  LitFix fix = LitFix::scale;
  KernelWidth kernel = KernelWidth::paper;
  BlockerDepth blocker = BlockerDepth::raw;
  float damping = 0.5F;       ///< a of exp(-a (k / K)^2)
  float search_scale = 1.0F;  ///< of the angle in which blockers are looked for
  float finer_levels = 0.0F;  ///< than the one as wide as the kernel; mip, ours
  float slope_bias = 0.0F;    ///< of the rise of the receiver's plane within a kernel; cssm, ours
  bool is_foreshortened = false;  ///< sizes by the cosine at the light; ours
  float contact_strength = 0.0F;  ///< A of s^(1 + A exp(-B (d - z_avg))); 0: off
  float contact_range = 10.0F;    ///< B, per unit of depth
  MomentSettings moments{};       ///< msm
};

/// What holds the area lights' shadows.
struct AreaShadows {
  const opengl::Buffer& area_lights;  ///< AreaLight
  const shadow_maps::HemisphereMaps& maps;
  const ConvolutionMaps* filtered = nullptr;  ///< of the same maps; cssm only
  const MomentMaps* moments = nullptr;        ///< of the same maps; msm only
};

/// Defines of a program that includes shaders/area_visibility.glsl.
opengl::Defines area_visibility_defines(const AreaVisibilitySettings& settings,
                                        const ConvolutionMaps* filtered);
/// Sets everything that shaders/area_visibility.glsl declares.
void bind_area_visibility(opengl::Program& program, const AreaVisibilitySettings& settings,
                          const AreaShadows& shadows);

/// Lights that one pass may gather, each of which may be the first of its cluster; nothing: any
/// number.
std::optional<int> most_lights_at_once(const AreaVisibilitySettings& settings,
                                       const ConvolutionMaps* filtered);

/// For the gather of lights that LightClusters::sort_runs has sorted. Refers to what `shadows`
/// does.
many_lights::GatherVisibility gather_visibility(const AreaVisibilitySettings& settings,
                                                const AreaShadows& shadows);

/// The share of one area light that every pixel of a geometry buffer sees. @param shown  rgba32f
void show_visibility(const opengl::GeometryBuffer& surfaces, int cluster,
                     const AreaVisibilitySettings& settings, const AreaShadows& shadows,
                     const opengl::Texture& shown);

}  // namespace renderers::clustered_visibility

#include "renderers/clustered_visibility/map_levels.h"

#include <cstdint>
#include <string>

#include "renderers/clustered_visibility/far_depth.h"
#include "renderers/clustered_visibility/shader_files.h"
#include "renderers/opengl/program.h"

namespace renderers::clustered_visibility {

namespace {

using opengl::Access;
using opengl::TextureFormat;

constexpr int kLocalSide = 8;   ///< of basis and mip_level
constexpr int kFirstLevel = 2;  ///< that mip_level finds made
constexpr std::uint32_t kSums = 6;
constexpr std::uint32_t kAreaLights = 7;

opengl::Program& program(opengl::Context& context, const std::string& pass,
                         const MapLevels& levels) {
  opengl::ProgramSource source{shader_files(),
                               {"renderers/clustered_visibility/shaders/" + pass + ".comp.glsl"},
                               levels.defines};
  const TextureFormat format = levels.first.shape().format;
  source.defines.emplace_back("FORMAT", shader_name_of(format));
  if (format == TextureFormat::rgba8_snorm) source.defines.emplace_back("EIGHT_BITS", "1");
  if (levels.second == nullptr) source.defines.emplace_back("ONE_TEXTURE", "1");
  return context.program(source);
}

}  // namespace

std::size_t level_sum_bytes(int size_px, int layers) {
  const auto side = static_cast<std::size_t>(size_px >> kFirstLevel);
  return (side * side * 4 - 1) / 3 * static_cast<std::size_t>(layers) * 8 * sizeof(float);
}

void make_levels(opengl::Context& context, const MapLevels& levels, const MapInput& input) {
  const int size_px = levels.first.shape().width_px;
  opengl::Program& basis = program(context, "basis", levels);
  basis.sampler(0, input.distances.distances());
  basis.storage(kAreaLights, input.area_lights);
  basis.storage(kSums, input.sums);
  basis.set("far_depth", kFarDepth);
  basis.set("map_size_px", size_px);
  for (int level = 0; level <= kFirstLevel; ++level) {
    const auto binding = static_cast<std::uint32_t>(level);
    basis.image(binding, levels.first, Access::write, level);
    if (levels.second != nullptr) basis.image(binding + 3, *levels.second, Access::write, level);
  }
  const std::uint32_t blocks = opengl::groups_for(size_px >> kFirstLevel, kLocalSide);
  basis.dispatch(blocks, blocks, static_cast<std::uint32_t>(input.distances.layers()));

  opengl::Program& mip = program(context, "mip_level", levels);
  mip.storage(kAreaLights, input.area_lights);
  mip.storage(kSums, input.sums);
  mip.set("map_size_px", size_px);
  for (int level = kFirstLevel + 1; level < levels.first.shape().levels; ++level) {
    mip.set("level", level);
    mip.image(0, levels.first, Access::write, level);
    if (levels.second != nullptr) mip.image(1, *levels.second, Access::write, level);
    const std::uint32_t groups = opengl::groups_for(size_px >> level, kLocalSide);
    mip.dispatch(groups, groups, static_cast<std::uint32_t>(levels.first.shape().layers));
  }
}

const char* shader_name_of(TextureFormat format) {
  switch (format) {
    case TextureFormat::rgba8_snorm:
      return "rgba8_snorm";
    case TextureFormat::rgba16f:
      return "rgba16f";
    case TextureFormat::r16f:
      return "r16f";
    case TextureFormat::r32f:
      return "r32f";
    default:
      return "rgba32f";
  }
}

}  // namespace renderers::clustered_visibility

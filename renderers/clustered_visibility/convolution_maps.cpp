#include "renderers/clustered_visibility/convolution_maps.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>
#include <utility>

#include "renderers/clustered_visibility/map_levels.h"
#include "renderers/clustered_visibility/shader_files.h"

namespace renderers::clustered_visibility {

namespace {

using opengl::Access;
using opengl::TextureFormat;

constexpr int kLocalLine = 32;  ///< of summed_area
constexpr std::uint32_t kAreaLights = 7;

}  // namespace

ConvolutionMaps::ConvolutionMaps(std::shared_ptr<opengl::Context> context, int size_px, int layers,
                                 const ConvolutionSettings& settings)
    : context_(std::move(context)), settings_(settings), size_px_(size_px), layers_(layers) {
  assert(settings.terms >= 1 && settings.terms <= kMostTerms);
  assert(size_px >= 4 && std::has_single_bit(static_cast<unsigned>(size_px)));
  step_ = make_textures(Kind::step);
  weighted_ = make_textures(Kind::weighted);
  depth_ = make_textures(Kind::depth);
  if (settings_.prefilter == Prefilter::sat) return;
  sums_ = opengl::Buffer(context_, level_sum_bytes(size_px, layers * groups()));
}

int ConvolutionMaps::table_scale() const {
  // The sum over a whole map of values in [-1, 1] must stay within 31 bits: a map without any
  // surface does hold ones, sin(4.5 pi) in the third term at depth 0.9.
  constexpr int kFinest = 1 << 15;
  const std::int64_t texels = std::int64_t{size_px_} * size_px_;
  constexpr std::int64_t kGreatest = std::numeric_limits<std::int32_t>::max();
  return static_cast<int>(std::clamp<std::int64_t>(kGreatest / texels, 1, kFinest));
}

ConvolutionMaps::Quantity ConvolutionMaps::make_textures(Kind kind) const {
  opengl::TextureShape shape;
  shape.width_px = size_px_;
  shape.height_px = size_px_;
  shape.layers = kind == Kind::depth ? layers_ : layers_ * groups();
  if (settings_.prefilter == Prefilter::sat) {
    shape.format = TextureFormat::rgba32i;
  } else {
    shape.levels = std::bit_width(static_cast<unsigned>(size_px_));
    const bool is_single = settings_.format == BasisFormat::bits_32;
    if (kind == Kind::depth) {
      shape.format = is_single ? TextureFormat::r32f : TextureFormat::r16f;
    } else if (kind == Kind::step && settings_.format == BasisFormat::bits_8) {
      shape.format = TextureFormat::rgba8_snorm;
    } else {
      shape.format = is_single ? TextureFormat::rgba32f : TextureFormat::rgba16f;
    }
  }
  Quantity quantity;
  quantity.first = opengl::Texture(context_, shape);
  if (kind != Kind::depth) quantity.second = opengl::Texture(context_, shape);
  if (settings_.prefilter == Prefilter::mip) {
    quantity.first.set_linear_filter(true);
    if (kind != Kind::depth) quantity.second.set_linear_filter(true);
  }
  return quantity;
}

opengl::Defines ConvolutionMaps::defines_of(Kind kind) const {
  opengl::Defines defines{{"TERMS", std::to_string(settings_.terms)},
                          {"GROUPS", std::to_string(kind == Kind::depth ? 1 : groups())}};
  if (kind == Kind::weighted) defines.emplace_back("WEIGHTED", "1");
  if (kind == Kind::depth) defines.emplace_back("DEPTH", "1");
  return defines;
}

void ConvolutionMaps::make(const shadow_maps::HemisphereMaps& distances,
                           const opengl::Buffer& area_lights) {
  assert(distances.size_px() == size_px_ && distances.layers() == layers_);
  for (const auto& [kind, quantity] :
       {std::pair{Kind::step, &step_}, std::pair{Kind::weighted, &weighted_},
        std::pair{Kind::depth, &depth_}}) {
    if (settings_.prefilter == Prefilter::sat) {
      make_tables(kind, *quantity, distances, area_lights);
    } else {
      make_levels(
          *context_,
          {quantity->first, kind == Kind::depth ? nullptr : &quantity->second, defines_of(kind)},
          {distances, area_lights, sums_});
    }
  }
  context_->check("filtering shadow maps");
}

void ConvolutionMaps::make_tables(Kind kind, const Quantity& quantity,
                                  const shadow_maps::HemisphereMaps& distances,
                                  const opengl::Buffer& area_lights) {
  for (const char* direction : {"ALONG_ROWS", "ALONG_COLUMNS"}) {
    opengl::ProgramSource source{shader_files(),
                                 {"renderers/clustered_visibility/shaders/summed_area.comp.glsl"},
                                 defines_of(kind)};
    source.defines.emplace_back("TABLE_SCALE", std::to_string(table_scale()));
    source.defines.emplace_back(direction, "1");
    opengl::Program& pass = context_->program(source);
    pass.sampler(0, distances.distances());
    pass.storage(kAreaLights, area_lights);
    pass.set("far_depth", kFarDepth);
    pass.image(0, quantity.first, Access::read_write);
    if (kind != Kind::depth) pass.image(1, quantity.second, Access::read_write);
    pass.dispatch(opengl::groups_for(size_px_, kLocalLine),
                  static_cast<std::uint32_t>(quantity.first.shape().layers));
  }
}

void ConvolutionMaps::bind(opengl::Program& program) const {
  program.sampler(4, sines());
  program.sampler(5, cosines());
  program.sampler(6, weighted_sines());
  program.sampler(7, weighted_cosines());
  program.sampler(9, depths());
}

std::int64_t ConvolutionMaps::layer_bytes() const {
  std::int64_t bytes = 0;
  for (const Quantity* quantity : {&step_, &weighted_, &depth_}) {
    bytes += opengl::size_bytes_of(quantity->first.shape());
    if (!quantity->second.is_empty()) bytes += opengl::size_bytes_of(quantity->second.shape());
  }
  return bytes;
}

std::int64_t ConvolutionMaps::memory_bytes() const {
  return layer_bytes() + static_cast<std::int64_t>(sums_.size_bytes());
}

}  // namespace renderers::clustered_visibility

#include "renderers/shadow_maps/hemisphere_maps.h"

#include <bit>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace renderers::shadow_maps {

namespace {

constexpr std::uint32_t kMapBinding = 8;

}  // namespace

HemisphereMaps::HemisphereMaps(std::shared_ptr<opengl::Context> context, int size_px, int layers)
    : context_(std::move(context)) {
  // The texture's own message does not say what its layers are for.
  const opengl::Limits& limits = context_->limits();
  if (size_px > limits.texture_size_px) {
    throw UnsupportedError(fmt::format("shadow maps of {0} x {0} px: this device allows {1} px",
                                       size_px, limits.texture_size_px));
  }
  if (layers > limits.array_layers) {
    throw UnsupportedError(fmt::format("{} shadow maps at once: this device allows {} layers",
                                       layers, limits.array_layers));
  }
  distances_ = opengl::Texture(context_, {.format = opengl::TextureFormat::r32ui,
                                          .width_px = size_px,
                                          .height_px = size_px,
                                          .layers = layers});
}

void HemisphereMaps::clear() {
  distances_.clear_words(std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity()));
}

void bind_hemisphere_maps(opengl::Program& program, const HemisphereMaps& maps,
                          const LookupBias& bias) {
  program.sampler(kMapBinding, maps.distances());
  program.set("hemisphere_near_m", maps.near_m());
  program.set("hemisphere_normal_offset", bias.normal_offset);
  program.set("hemisphere_depth_bias", bias.depth);
}

}  // namespace renderers::shadow_maps

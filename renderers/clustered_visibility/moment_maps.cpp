#include "renderers/clustered_visibility/moment_maps.h"

#include <bit>
#include <cassert>
#include <utility>

#include "renderers/clustered_visibility/map_levels.h"

namespace renderers::clustered_visibility {

MomentMaps::MomentMaps(std::shared_ptr<opengl::Context> context, int size_px, int layers)
    : context_(std::move(context)) {
  assert(size_px >= 4 && std::has_single_bit(static_cast<unsigned>(size_px)));
  opengl::TextureShape shape;
  shape.format = opengl::TextureFormat::rgba32f;
  shape.width_px = size_px;
  shape.height_px = size_px;
  shape.layers = layers;
  shape.levels = std::bit_width(static_cast<unsigned>(size_px));
  moments_ = opengl::Texture(context_, shape);
  moments_.set_linear_filter(true);
  sums_ = opengl::Buffer(context_, level_sum_bytes(size_px, layers));
}

void MomentMaps::make(const shadow_maps::HemisphereMaps& distances,
                      const opengl::Buffer& area_lights) {
  assert(distances.size_px() == moments_.shape().width_px);
  assert(distances.layers() == moments_.shape().layers);
  make_levels(*context_, {moments_, nullptr, {{"TERMS", "1"}, {"GROUPS", "1"}, {"MOMENTS", "1"}}},
              {distances, area_lights, sums_});
  context_->check("filtering moments of shadow maps");
}

}  // namespace renderers::clustered_visibility

#include "renderers/shadow_maps/map_filler.h"

#include <utility>

namespace renderers::shadow_maps {

namespace {

using Maps = std::variant<HardMaps, HemicubeMaps, VertexMaps>;

Maps make_maps(std::shared_ptr<opengl::Context> context, DepthBackend backend,
               const VertexMapSettings& vertex) {
  switch (backend) {
    case DepthBackend::hemicube:
      return HemicubeMaps(std::move(context));
    case DepthBackend::vertex:
      return VertexMaps(std::move(context), vertex);
    default:
      return HardMaps(std::move(context));
  }
}

}  // namespace

MapFiller::MapFiller(std::shared_ptr<opengl::Context> context, DepthBackend backend,
                     const VertexMapSettings& vertex)
    : maps_(make_maps(std::move(context), backend, vertex)) {}

void MapFiller::load(const scene::Scene& scene, StageTimer& timer) {
  if (auto* maps = std::get_if<VertexMaps>(&maps_)) maps->load(scene, timer);
}

void MapFiller::fill(HemisphereMaps& maps, const opengl::GpuScene& scene, const MapOrigins& origins,
                     int first, int count) {
  std::visit([&](auto& filler) { filler.fill(maps, scene, origins, first, count); }, maps_);
}

int MapFiller::triangle_count(const opengl::GpuScene& scene) const {
  const auto* maps = std::get_if<VertexMaps>(&maps_);
  return maps != nullptr ? maps->piece_count() : scene.triangle_count();
}

int MapFiller::draw_count(int maps) const {
  if (const auto* vertex = std::get_if<VertexMaps>(&maps_)) return vertex->draw_count(maps);
  return std::holds_alternative<HemicubeMaps>(maps_) ? HemicubeMaps::draw_count(maps) : 0;
}

std::int64_t MapFiller::memory_bytes() const {
  return std::visit([](const auto& maps) { return maps.memory_bytes(); }, maps_);
}

}  // namespace renderers::shadow_maps

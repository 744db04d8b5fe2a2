#include "renderers/ray_bundles/texture_detail.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace renderers::ray_bundles {

namespace {

bool is_textured(const scene::Material& material) {
  const bool emits = material.is_emissive() && material.emission_texture != scene::kNoTexture;
  return emits || material.albedo_texture != scene::kNoTexture;
}

glm::vec3 texture_at(const scene::Scene& scene, int texture, const glm::vec2& uv) {
  if (texture == scene::kNoTexture) return glm::vec3(1.0F);
  return scene::sample_texture(scene.textures[static_cast<std::size_t>(texture)], uv);
}

}  // namespace

TextureDetail::TextureDetail(const ray_tracing::RayScene& rays,
                             const texel_atlas::TexelAtlas& atlas)
    : rays_(rays), atlas_(atlas) {
  std::vector<Reach> reaches;
  const scene::Scene& scene = rays.scene();
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    const auto material = static_cast<std::size_t>(scene.objects[object].material);
    if (is_textured(scene.materials[material])) add_object(object, reaches);
  }
  if (!is_empty()) sort_reaches(reaches);
}

void TextureDetail::add_object(std::uint32_t object, std::vector<Reach>& reaches) {
  const scene::Object& source = rays_.scene().objects[object];
  for (std::uint32_t i = 0; i < source.mesh->triangles.size(); ++i) {
    const texel_atlas::TriangleMap& map = atlas_.map_of(object, i);
    const float turn = map.along_u.x * map.along_v.y - map.along_u.y * map.along_v.x;
    if (map.chart == texel_atlas::kNoTexel || !(std::fabs(turn) > 1e-20F)) continue;
    Piece piece;
    piece.corner = map.corner;
    piece.second_of = glm::vec2(map.along_v.y, -map.along_v.x) / turn;
    piece.third_of = glm::vec2(-map.along_u.y, map.along_u.x) / turn;
    const auto uv_at = [&](const glm::vec2& barycentrics) {
      return rays_.point_on_triangle(object, i, barycentrics).uv;
    };
    piece.uv = uv_at({0.0F, 0.0F});
    piece.uv_second = uv_at({1.0F, 0.0F}) - piece.uv;
    piece.uv_third = uv_at({0.0F, 1.0F}) - piece.uv;
    piece.material = source.material;
    pieces_.push_back(piece);
    add_reaches(map.chart, map, reaches);
  }
}

/// Of the piece added last: the texels of all cells around its triangle, so that rounding finds it,
/// too.
void TextureDetail::add_reaches(std::uint32_t chart, const texel_atlas::TriangleMap& map,
                                std::vector<Reach>& reaches) const {
  const texel_atlas::ChartPlace& place = atlas_.layout().places[chart];
  const glm::vec2 second = map.corner + map.along_u;
  const glm::vec2 third = map.corner + map.along_v;
  const glm::ivec2 last = place.corner + place.size - 1;
  constexpr float kRounding = 1e-3F;
  const auto cell_of = [&](const glm::vec2& at) {
    return glm::clamp(glm::ivec2(glm::floor(at)), place.corner, last);
  };
  const glm::ivec2 low = cell_of(glm::min(map.corner, glm::min(second, third)) - kRounding);
  const glm::ivec2 high = cell_of(glm::max(map.corner, glm::max(second, third)) + kRounding);
  const auto piece = static_cast<std::uint32_t>(pieces_.size() - 1);
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      const std::uint32_t texel = atlas_.texel_in({x, y});
      if (texel != texel_atlas::kNoTexel) reaches.push_back({texel, piece});
    }
  }
}

void TextureDetail::sort_reaches(std::vector<Reach>& reaches) {
  const auto comes_before = [](const Reach& a, const Reach& b) {
    return a.texel != b.texel ? a.texel < b.texel : a.piece < b.piece;
  };
  std::sort(reaches.begin(), reaches.end(), comes_before);
  const auto is_same = [](const Reach& a, const Reach& b) {
    return a.texel == b.texel && a.piece == b.piece;
  };
  reaches.erase(std::unique(reaches.begin(), reaches.end(), is_same), reaches.end());
  covers_.resize(atlas_.texels().size());
  piece_of_.reserve(reaches.size());
  for (const Reach& reach : reaches) {
    Cover& cover = covers_[reach.texel];
    const auto at = static_cast<std::uint32_t>(piece_of_.size());
    if (cover.begin == cover.end) cover.begin = at;
    cover.end = at + 1;
    piece_of_.push_back(reach.piece);
  }
}

std::optional<PointColors> TextureDetail::at(std::uint32_t texel, const glm::vec3& position) const {
  if (covers_.empty()) return std::nullopt;
  const Cover& cover = covers_[texel];
  if (cover.begin == cover.end) return std::nullopt;
  const texel_atlas::Texel& own = atlas_.texels()[texel];
  const texel_atlas::ChartPlace& place = atlas_.layout().places[own.chart];
  const glm::vec2 at(atlas_.charts()[own.chart].project(glm::dvec3(position)) * place.texels_per_m +
                     glm::dvec2(place.corner));
  // The piece that holds the point, or is nearest to holding it.
  const Piece* found = nullptr;
  glm::vec2 weights(0.0F);
  float least = -std::numeric_limits<float>::infinity();
  for (std::uint32_t i = cover.begin; i < cover.end && least < 0.0F; ++i) {
    const Piece& piece = pieces_[piece_of_[i]];
    const glm::vec2 offset = at - piece.corner;
    const glm::vec2 tried(glm::dot(piece.second_of, offset), glm::dot(piece.third_of, offset));
    const float inside = std::min({tried.x, tried.y, 1.0F - tried.x - tried.y});
    if (found != nullptr && inside <= least) continue;
    found = &piece;
    weights = tried;
    least = inside;
  }
  weights = glm::max(weights, glm::vec2(0.0F));
  weights /= std::max(1.0F, weights.x + weights.y);
  const scene::Scene& scene = rays_.scene();
  const auto& material = scene.materials[static_cast<std::size_t>(found->material)];
  const glm::vec2 uv = found->uv + weights.x * found->uv_second + weights.y * found->uv_third;
  PointColors colors;
  if (material.is_emissive()) {
    colors.emission = material.emission * texture_at(scene, material.emission_texture, uv);
  }
  if (material.albedo_texture == scene::kNoTexture) return colors;
  const glm::vec3 albedo = material.albedo * texture_at(scene, material.albedo_texture, uv);
  for (glm::length_t c = 0; c < 3; ++c) {
    if (own.albedo[c] > 0.0F) colors.albedo_ratio[c] = albedo[c] / own.albedo[c];
  }
  return colors;
}

std::int64_t TextureDetail::memory_bytes() const {
  return static_cast<std::int64_t>(pieces_.size() * sizeof(Piece) + covers_.size() * sizeof(Cover) +
                                   piece_of_.size() * sizeof(std::uint32_t));
}

}  // namespace renderers::ray_bundles

#include "renderers/scene/generators/atrium.h"

#include "renderers/scene/generators/atrium_building.h"
#include "renderers/scene/value_reader.h"

#include <array>
#include <cstdlib>
#include <utility>

namespace renderers::scene {
namespace {

constexpr int kDefaultTriangles = 98000;
constexpr int kLeastTriangles = 45000;
constexpr int kMostTriangles = 1000000;

/// Edges that turn by less look round.
constexpr float kCrease_deg = 38.0F;

/// Colours of the parts if the scene gives none: stone, wood, cloth; ours.
struct PartColor {
  const char* part;
  glm::vec3 albedo;
  float emission;
};
constexpr std::array<PartColor, 17> kColors{{{"arcade", {0.62F, 0.57F, 0.48F}, 0.0F},
                                             {"balustrade", {0.66F, 0.62F, 0.54F}, 0.0F},
                                             {"banners", {0.20F, 0.27F, 0.50F}, 0.0F},
                                             {"columns", {0.66F, 0.62F, 0.54F}, 0.0F},
                                             {"curtain-a", {0.55F, 0.11F, 0.09F}, 0.0F},
                                             {"curtain-b", {0.15F, 0.36F, 0.16F}, 0.0F},
                                             {"floor", {0.45F, 0.42F, 0.38F}, 0.0F},
                                             {"gallery", {0.50F, 0.45F, 0.38F}, 0.0F},
                                             {"plants", {0.12F, 0.30F, 0.08F}, 0.0F},
                                             {"roof", {0.58F, 0.52F, 0.44F}, 0.0F},
                                             {"shell", {0.50F, 0.45F, 0.38F}, 0.0F},
                                             {"skylight", {0.0F, 0.0F, 0.0F}, 10.0F},
                                             {"vases", {0.52F, 0.36F, 0.26F}, 0.0F},
                                             {"vaults", {0.64F, 0.58F, 0.48F}, 0.0F},
                                             {"voussoirs", {0.60F, 0.50F, 0.38F}, 0.0F},
                                             {"walls", {0.60F, 0.53F, 0.42F}, 0.0F},
                                             {"wood", {0.26F, 0.16F, 0.09F}, 0.0F}}};

std::size_t size_of(const AtriumParts& parts) {
  std::size_t size = 0;
  for (const auto& [name, soup] : parts) size += soup.size();
  return size;
}

/// The level of detail below the target, then the finest cloth that still fits.
AtriumParts build_with(std::uint64_t seed, std::size_t triangles) {
  AtriumDetail detail;
  const auto size_at = [&](float level, int rows) {
    detail = {level, rows};
    return size_of(atrium_building(seed, detail));
  };
  float low = 0.3F;
  float high = 6.0F;
  constexpr int kHalvings = 10;
  for (int i = 0; i < kHalvings; ++i) {
    const float middle = 0.5F * (low + high);
    const auto rows = static_cast<int>(26.0F * middle);
    (size_at(middle, rows) <= triangles ? low : high) = middle;
  }
  int rows = static_cast<int>(26.0F * low);
  while (size_at(low, rows + 1) <= triangles) ++rows;
  return atrium_building(seed, {low, rows});
}

Material material_of(const std::string& part) {
  Material material;
  for (const PartColor& color : kColors) {
    if (part != color.part) continue;
    material.albedo = color.albedo;
    material.emission = glm::vec3(color.emission);
  }
  return material;
}

}  // namespace

std::vector<GeneratedPart> atrium(base::MapReader& reader) {
  const auto seed = static_cast<std::uint64_t>(reader.integer("seed", 1));
  const base::Node* node = reader.find("triangles");
  const int triangles = node == nullptr
                            ? kDefaultTriangles
                            : read_count(*node, "triangles", kLeastTriangles, kMostTriangles);
  std::vector<GeneratedPart> parts;
  for (const auto& [name, soup] : build_with(seed, static_cast<std::size_t>(triangles))) {
    parts.push_back({name, soup.to_mesh(kCrease_deg), material_of(name), nullptr});
  }
  return parts;
}

}  // namespace renderers::scene

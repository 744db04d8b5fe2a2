#include "renderers/scene/material_reader.h"

#include "perception/base/names.h"
#include "renderers/scene/emission_profile.h"
#include "renderers/scene/texture_reader.h"
#include "renderers/scene/value_reader.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <utility>

namespace renderers::scene {
namespace {

/// Room for the rounding of numbers such as 0.7 + 0.3.
constexpr float kEnergyTolerance = 1e-6F;

/// Largest exponent: a lobe of 0.06 degrees, beyond it floats cannot tell directions apart.
constexpr float kMaxPhongExponent = 1e6F;

/// Least width of a GGX lobe, half as sharp as one of the greatest exponent.
constexpr float kMinGgxAlpha = 1e-3F;

/// Largest factor of an emission profile: what a beam of a tenth of a degree takes to have the flux
/// of an emitter without one.
constexpr float kMostProfileFactor = 1e6F;

class MaterialReader {
 public:
  MaterialReader(const NamedSource& source, MaterialTable& table)
      : source_(source),
        table_(table),
        reader_(*source.source.node, fmt::format("material \"{}\"", source.name)) {}

  void read() {
    material_.name = source_.name;
    material_.albedo_texture = read_texture_key("albedo_texture");
    material_.emission_texture = read_texture_key("emission_texture");
    const bool has_albedo_texture = material_.albedo_texture != kNoTexture;
    const bool has_emission_texture = material_.emission_texture != kNoTexture;
    material_.albedo = glm::vec3(has_albedo_texture ? 1.0F : 0.0F);
    material_.emission = glm::vec3(has_emission_texture ? 1.0F : 0.0F);
    if (const auto* node = reader_.find("albedo")) {
      material_.albedo = read_reflectance(*node, "albedo");
    }
    if (const auto* node = reader_.find("emission")) {
      material_.emission = read_color(*node, "emission");
    }
    read_emission_profile();
    read_lobe();
    check_energy(material_.albedo, reader_.node().place());
    read_animation();
    reader_.finish();
    table_.materials.push_back(std::move(material_));
  }

 private:
  int read_texture_key(const char* key) {
    const base::Node* node = reader_.find(key);
    if (node == nullptr) return kNoTexture;
    table_.textures.push_back(
        read_texture(*node, fmt::format("{}.{}", source_.name, key), source_.source.folder));
    return static_cast<int>(table_.textures.size()) - 1;
  }

  void read_emission_profile() {
    const base::Node* node = reader_.find("emission_profile");
    if (node == nullptr) return;
    std::vector<float>& profile = material_.emission_profile;
    for (const base::Node& value : node->list("emission_profile")) {
      profile.push_back(read_in_range(value, "emission_profile", 0.0F, kMostProfileFactor));
    }
    if (profile.size() < 2 || profile.size() > kMostProfileValues) {
      throw base::InputError(
          node->place(),
          fmt::format("material \"{}\" has an emission_profile of {} values; accepted: "
                      "2 to {}, at equal angles from the normal to the surface",
                      source_.name, profile.size(), kMostProfileValues));
    }
    if (!material_.is_emissive()) {
      throw base::InputError(node->place(),
                             fmt::format("material \"{}\" has an emission_profile and no emission; "
                                         "accepted: with emission or emission_texture",
                                         source_.name));
    }
    if (std::ranges::all_of(profile, [](float value) { return value == 0.0F; })) {
      throw base::InputError(
          node->place(),
          fmt::format("material \"{}\" has an emission_profile of zeros alone; accepted: at least "
                      "one above 0",
                      source_.name));
    }
  }

  void read_lobe() {
    const base::Node* phong = reader_.find("phong");
    const base::Node* ggx = reader_.find("ggx");
    if (phong != nullptr && ggx != nullptr) {
      throw base::InputError(
          ggx->place(),
          fmt::format("material \"{}\" has the lobes phong and ggx; accepted: one", source_.name));
    }
    if (phong != nullptr) read_phong(*phong);
    if (ggx != nullptr) read_ggx(*ggx);
  }

  void read_phong(const base::Node& node) {
    base::MapReader reader(node, "phong");
    material_.lobe.albedo = read_reflectance(reader.require("albedo"), "phong albedo");
    material_.lobe.exponent =
        read_in_range(reader.require("exponent"), "exponent", 0.0F, kMaxPhongExponent);
    reader.finish();
  }

  void read_ggx(const base::Node& node) {
    base::MapReader reader(node, "ggx");
    material_.lobe.shape = LobeShape::ggx;
    material_.lobe.albedo = read_reflectance(reader.require("albedo"), "ggx albedo");
    material_.lobe.alpha = read_in_range(reader.require("alpha"), "alpha", kMinGgxAlpha, 1.0F);
    reader.finish();
  }

  void read_animation() {
    const auto read_key = [&](base::MapReader& key, const MaterialColors& rest) {
      MaterialColors colors = rest;
      if (const auto* node = key.find("albedo")) colors.albedo = read_reflectance(*node, "albedo");
      if (const auto* node = key.find("emission")) colors.emission = read_color(*node, "emission");
      check_energy(colors.albedo, key.node().place());
      return colors;
    };
    const MaterialColors rest{material_.albedo, material_.emission};
    Track<MaterialColors> track = read_track(reader_, rest, read_key);
    if (track.is_animated) table_.tracks.push_back({table_.materials.size(), std::move(track)});
  }

  /// A surface must not send back more than it gets.
  void check_energy(glm::vec3 albedo, const base::Place& place) const {
    if (material_.albedo_texture != kNoTexture) {
      const auto index = static_cast<std::size_t>(material_.albedo_texture);
      albedo *= largest_values(table_.textures[index].image);
    }
    const glm::vec3 sum = albedo + material_.lobe.albedo;
    for (int i = 0; i < 3; ++i) {
      if (sum[i] <= 1.0F + kEnergyTolerance) continue;
      throw base::InputError(
          place,
          fmt::format("material \"{}\" reflects more than it receives: {} + {} = {} in channel {}; "
                      "albedo (times texture) + the lobe's albedo must be at most 1",
                      source_.name, albedo[i], material_.lobe.albedo[i], sum[i], "RGB"[i]));
    }
  }

  const NamedSource& source_;
  MaterialTable& table_;
  base::MapReader reader_;
  Material material_;
};

}  // namespace

MaterialTable read_materials(const std::vector<NamedSource>& sources) {
  MaterialTable table;
  for (const NamedSource& source : sources) MaterialReader(source, table).read();
  return table;
}

MaterialColors mix_colors(const MaterialColors& a, const MaterialColors& b, float t) {
  return {glm::mix(a.albedo, b.albedo, t), glm::mix(a.emission, b.emission, t)};
}

int find_material(const MaterialTable& table, std::string_view name, const base::Place& place) {
  std::vector<std::string> known;
  for (const Material& material : table.materials) {
    if (base::is_same_name(material.name, name)) return static_cast<int>(known.size());
    known.push_back(material.name);
  }
  throw base::InputError(place, base::unknown_name("material", name, known));
}

}  // namespace renderers::scene

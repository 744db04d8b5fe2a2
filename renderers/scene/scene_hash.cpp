#include "renderers/scene/scene_hash.h"

#include <glm/gtc/type_ptr.hpp>

#include <cstdint>
#include <span>

namespace renderers::scene {
namespace {

class SceneHasher {
 public:
  explicit SceneHasher(const Scene& scene) : scene_(scene) {}

  base::Hash run(const std::vector<base::Hash>& mesh_hashes, bool with_camera) {
    hasher_.add(scene_.luminance_scale_cd_m2);
    if (with_camera) add_camera();
    hasher_.add(static_cast<std::int64_t>(scene_.objects.size()));
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
      hasher_.add(mesh_hashes[i].hex());
      hasher_.add(std::span<const float>(glm::value_ptr(scene_.objects[i].to_world), 16));
      add_material(scene_.materials[static_cast<std::size_t>(scene_.objects[i].material)]);
    }
    hasher_.add(static_cast<std::int64_t>(scene_.lights.size()));
    for (const Light& light : scene_.lights) add_light(light);
    add_environment();
    return hasher_.finish();
  }

 private:
  void add_vec3(const glm::vec3& v) { hasher_.add(std::span<const float>(glm::value_ptr(v), 3)); }
  void add_float(float value) { hasher_.add(static_cast<double>(value)); }

  void add_camera() {
    add_vec3(scene_.camera.position);
    add_vec3(scene_.camera.look_at);
    add_vec3(scene_.camera.up);
    add_float(scene_.camera.vertical_fov_deg);
  }

  void add_texture(int index) {
    if (index == kNoTexture) {
      hasher_.add(std::string_view("no texture"));
    } else {
      add_image(scene_.textures[static_cast<std::size_t>(index)].image);
    }
  }

  void add_image(const perception::Image& image) {
    hasher_.add(static_cast<std::int64_t>(image.width_px));
    hasher_.add(static_cast<std::int64_t>(image.height_px));
    hasher_.add(std::span<const float>(image.pixels));
  }

  void add_material(const Material& material) {
    add_vec3(material.albedo);
    add_texture(material.albedo_texture);
    add_vec3(material.lobe.albedo);
    add_float(material.lobe.exponent);
    if (material.lobe.shape == LobeShape::ggx) {
      hasher_.add(std::string_view("ggx"));
      add_float(material.lobe.alpha);
    }
    add_vec3(material.emission);
    add_texture(material.emission_texture);
    if (!material.emission_profile.empty()) {
      hasher_.add(std::string_view("emission profile"));
      hasher_.add(std::span<const float>(material.emission_profile));
    }
  }

  void add_light(const Light& light) {
    hasher_.add(std::string_view(light.type == LightType::spot ? "spot" : "point"));
    add_vec3(light.position);
    add_vec3(light.intensity);
    if (light.type != LightType::spot) return;
    add_vec3(light.direction);
    add_float(light.inner_cone_rad);
    add_float(light.outer_cone_rad);
  }

  void add_environment() {
    if (!scene_.environment) {
      hasher_.add(std::string_view("no environment"));
      return;
    }
    add_image(scene_.environment->image);
    add_float(scene_.environment->scale);
    add_float(scene_.environment->rotation_rad);
  }

  const Scene& scene_;
  base::Hasher hasher_;
};

}  // namespace

base::Hash content_hash(const Scene& scene, const std::vector<base::Hash>& mesh_hashes) {
  return SceneHasher(scene).run(mesh_hashes, true);
}

base::Hash world_hash(const Scene& scene, const std::vector<base::Hash>& mesh_hashes) {
  return SceneHasher(scene).run(mesh_hashes, false);
}

}  // namespace renderers::scene

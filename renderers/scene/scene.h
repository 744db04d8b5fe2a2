#pragma once

#include "perception/base/hash.h"
#include "perception/image.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

/// Scenes as renderers see them: metres, right-handed, y up; linear Rec.709 D65; radiance in
/// W/(m2 sr), intensity of point and spot lights in W/sr.
namespace renderers::scene {

/// Pinhole camera.
struct Camera {
  glm::vec3 position{0.0F, 0.0F, 0.0F};
  glm::vec3 look_at{0.0F, 0.0F, 1.0F};
  glm::vec3 up{0.0F, 1.0F, 0.0F};
  float vertical_fov_deg = 40.0F;
};

/// An image on a surface. Its first row is v = 1 (top), rows repeat, bilinear filtering.
struct Texture {
  std::string name;
  perception::Image image;  ///< R, G, B, scene_linear
};

inline constexpr int kNoTexture = -1;

enum class LobeShape { phong, ggx };

/// What a surface reflects besides its Lambert part; formulas in `ray_tracing/glossy_lobe.h`.
struct GlossyLobe {
  /// Phong: reflectance at normal incidence; GGX: of the microfacets, the same for every angle.
  glm::vec3 albedo{0.0F};
  LobeShape shape = LobeShape::phong;
  float exponent = 0.0F;  ///< Phong: n
  float alpha = 0.0F;     ///< GGX: width of the distribution of slopes, in (0, 1]
};

/// Lambert + one glossy lobe + emission; one-sided in reflection: light meets the side that is
/// looked at (both sides reflect alike); emission leaves the front side (counter-clockwise) only.
struct Material {
  std::string name;
  glm::vec3 albedo{0.0F};  ///< diffuse reflectance, multiplied by the texture
  int albedo_texture = kNoTexture;
  GlossyLobe lobe;
  glm::vec3 emission{0.0F};  ///< radiance, multiplied by the texture
  int emission_texture = kNoTexture;
  std::vector<float> emission_profile;  ///< factors by angle, `emission_factor`; empty: none

  bool is_emissive() const { return emission.x > 0 || emission.y > 0 || emission.z > 0; }
  bool is_glossy() const { return lobe.albedo.x > 0 || lobe.albedo.y > 0 || lobe.albedo.z > 0; }
};

/// Triangles in object space. Normals and uvs are per vertex or absent (empty).
struct Mesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< unit length; empty: flat triangles
  std::vector<glm::vec2> uvs;
  std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from the front
};

struct Object {
  std::string name;
  std::shared_ptr<const Mesh> mesh;
  int material = 0;
  glm::mat4 to_world{1.0F};
};

enum class LightType { point, spot };

/// Area lights are objects with emission, not lights of this list.
struct Light {
  std::string name;
  LightType type = LightType::point;
  glm::vec3 position{0.0F};
  glm::vec3 intensity{0.0F};               ///< W/sr, along the axis for a spot
  glm::vec3 direction{0.0F, -1.0F, 0.0F};  ///< unit length, spot only
  float inner_cone_rad = 0.0F;             ///< half angle of full intensity, spot only
  float outer_cone_rad = 0.0F;             ///< half angle of zero intensity, spot only
};

/// Radiance from every direction, a latitude-longitude map: row 0 is +y, column 0 and the last
/// column meet at -z, the image's centre column looks along +z and columns grow towards -x: the map
/// is what a viewer inside sees. Rotated about +y by `rotation_rad` (+z turns towards +x).
struct Environment {
  perception::Image image;  ///< R, G, B, scene_linear
  float scale = 1.0F;
  float rotation_rad = 0.0F;
};

/// State of a scene at one frame.
struct Scene {
  std::string name;
  double luminance_scale_cd_m2 = 100.0;  ///< luminance of radiance 1.0
  Camera camera;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Object> objects;
  std::vector<Light> lights;
  std::shared_ptr<const Environment> environment;  ///< null: black
  base::Hash hash;        ///< of everything that makes an image, this frame's state
  base::Hash world_hash;  ///< of the same but the camera; zero: not known
  int frame_index = 0;
  bool is_animated = false;

  std::size_t face_count() const;
};

/// Axis-aligned bounds of all triangles in world space; least > greatest if there are none.
struct Box {
  glm::vec3 least{std::numeric_limits<float>::infinity()};
  glm::vec3 greatest{-std::numeric_limits<float>::infinity()};
  /// Length of the diagonal, m; 0 without triangles.
  float diagonal_m() const;
};
Box bounding_box(const Scene& scene);
/// The first object with a vertex in world space that is NaN or infinite; null if there is none.
const Object* find_non_finite(const Scene& scene);

/// Intensity of a spot or point light towards a direction, W/sr. Spot fall-off between the cones:
/// t^2 (3 - 2 t), t = (cos a - cos outer) / (cos inner - cos outer).
/// @param to_point  unit length, from the light
glm::vec3 intensity_towards(const Light& light, const glm::vec3& to_point);

/// Bilinear lookup with repeat. @param uv  v up
glm::vec3 sample_texture(const Texture& texture, const glm::vec2& uv);

/// Position of a direction in the map. @param direction  unit length, world space
/// @return x from the left edge, y from the top edge, each in [0, 1]
glm::vec2 environment_position(const Environment& environment, const glm::vec3& direction);
/// Inverse of `environment_position`, unit length, world space.
glm::vec3 environment_direction(const Environment& environment, const glm::vec2& position);

/// Bilinear radiance from a direction; repeats in x, ends at the poles in y.
/// @param direction  unit length, world space
glm::vec3 sample_environment(const Environment& environment, const glm::vec3& direction);

enum class Feature {
  point_light,
  spot_light,
  area_light,
  emission_profile,  ///< area lights whose radiance depends on the direction
  environment,
  texture,
  glossy,
  animation
};
std::string to_string(Feature feature);  ///< "point-light", ...
std::vector<Feature> features_of(const Scene& scene);

/// Ray direction through a pixel position (px from the left, py from the top), unit length.
glm::vec3 camera_ray_direction(const Camera& camera, int width_px, int height_px, float px,
                               float py);

}  // namespace renderers::scene

#include "tests/renderers/opengl/surface_oracle.h"

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "tests/renderers/scene_builder.h"

namespace renderers::opengl {

namespace {

/// Corners and vertex normals of a triangle in world space.
struct WorldTriangle {
  std::array<glm::dvec3, 3> position;
  std::array<glm::dvec3, 3> normal;
  std::array<glm::dvec2, 3> uv;
};

WorldTriangle world_triangle(const scene::Object& object, std::uint32_t index) {
  const scene::Mesh& mesh = *object.mesh;
  const glm::dmat3 linear{glm::dmat4(object.to_world)};
  const bool mirrors = glm::determinant(linear) < 0.0;
  const glm::uvec3 corners = mesh.triangles[index];
  const glm::dmat3 normal_to_world = glm::transpose(glm::inverse(linear));
  WorldTriangle triangle;
  for (glm::length_t i = 0; i < 3; ++i) {
    // The corners of a mirrored triangle, the other way round.
    const std::uint32_t vertex = corners[mirrors ? (3 - i) % 3 : i];
    const auto at = static_cast<std::size_t>(i);
    triangle.position[at] =
        glm::dvec3(glm::vec3(object.to_world * glm::vec4(mesh.positions[vertex], 1.0F)));
    triangle.normal[at] = mesh.normals.empty()
                              ? glm::dvec3(0.0)
                              : glm::normalize(normal_to_world * glm::dvec3(mesh.normals[vertex]));
    triangle.uv[at] = mesh.uvs.empty() ? glm::dvec2(0.0) : glm::dvec2(mesh.uvs[vertex]);
  }
  return triangle;
}

scene::Texture noise_texture() {
  scene::Texture texture;
  texture.image = perception::make_rgb_image(13, 7, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < texture.image.pixels.size(); ++i) {
    texture.image.pixels[i] = std::fmod(0.754877F * static_cast<float>(i), 1.0F);
  }
  return texture;
}

void add_mesh(scene::Scene& scene, scene::Mesh mesh, int material) {
  scene::Object object;
  object.mesh = std::make_shared<const scene::Mesh>(std::move(mesh));
  object.material = material;
  scene.objects.push_back(std::move(object));
}

}  // namespace

scene::Scene surface_scene() {
  test::SceneBuilder builder;
  builder.scene.textures.push_back(noise_texture());
  scene::Material tiles = test::lambert({0.9F, 0.8F, 0.7F});
  tiles.albedo_texture = 0;
  const int white = builder.add_material(test::lambert({0.5F, 0.6F, 0.7F}));
  const int tiled = builder.add_material(tiles);
  const int glossy = builder.add_material(test::phong({0.3F, 0.1F, 0.2F}, {0.2F, 0.2F, 0.2F}, 30));

  builder.add_box({-4, 0, -5}, {4, 5, 5}, white, true);
  const int floor = builder.add_quad({-4, 0.01F, 5}, {8, 0, 0}, {0, 0, -10}, tiled);
  auto repeated = std::make_shared<scene::Mesh>(*builder.scene.objects[std::size_t(floor)].mesh);
  for (glm::vec2& uv : repeated->uvs) uv = uv * glm::vec2(3.5F, -4.25F) - glm::vec2(20.3F, 1.6F);
  builder.scene.objects[std::size_t(floor)].mesh = repeated;

  const int sphere = builder.add_sphere({0, 0, 0}, 1.0F, 12, white);
  glm::mat4 pose = glm::translate(glm::mat4(1.0F), {-1.5F, 1.6F, 0.5F});
  pose = glm::rotate(pose, 0.7F, glm::vec3(0.6F, 0.8F, 0.0F));
  builder.scene.objects[std::size_t(sphere)].to_world = glm::scale(pose, {-1.2F, 0.7F, 1.0F});
  builder.add_sphere({1.7F, 0.8F, -1.0F}, 0.7F, 9, glossy);
  builder.add_box({0.5F, 0.02F, 1.0F}, {1.5F, 1.3F, 2.0F}, glossy, false);

  scene::Mesh sliver;
  sliver.positions = {{0, 1, 0}, {0, 2, 0}, {0, 3, 0}, {-0.5F, 3.0F, 1.0F}};
  sliver.triangles = {{0, 1, 2}, {0, 0, 1}, {0, 3, 2}};
  add_mesh(builder.scene, std::move(sliver), white);
  builder.look({0.4F, 2.6F, 4.6F}, {-0.2F, 1.5F, 0.0F}, 65.0F);
  return builder.scene;
}

OracleRay ray_of(const View& view, const glm::ivec2& size_px, const glm::dvec2& position_px) {
  const glm::dvec2 place = 2.0 * position_px / glm::dvec2(size_px) - 1.0;
  const glm::dvec3 across = (view.center.x + place.x * view.half_width) * glm::dvec3(view.right) +
                            (view.center.y - place.y * view.half_height) * glm::dvec3(view.up);
  const glm::dvec3 origin(view.origin);
  const glm::dvec3 forward(view.forward);
  return view.is_orthographic ? OracleRay{origin + across, forward, origin}
                              : OracleRay{origin, glm::normalize(forward + across), origin};
}

std::optional<OracleSurface> surface_along(const ray_tracing::RayScene& ray_scene,
                                           const OracleRay& ray) {
  ray_tracing::Hit hit;
  if (!ray_scene.intersect({glm::vec3(ray.origin), glm::vec3(ray.direction)}, hit)) {
    return std::nullopt;
  }
  const scene::Scene& scene = ray_scene.scene();
  const scene::Object& object = scene.objects[hit.object];
  const scene::Material& material = scene.materials[static_cast<std::size_t>(object.material)];
  const WorldTriangle triangle = world_triangle(object, hit.triangle);

  const glm::dvec3 ab = triangle.position[1] - triangle.position[0];
  const glm::dvec3 ac = triangle.position[2] - triangle.position[0];
  const glm::dvec3 scaled = glm::cross(ab, ac);
  OracleSurface surface;
  surface.object = hit.object;
  surface.triangle = hit.triangle;
  surface.material = object.material;
  surface.is_glossy = material.is_glossy();
  const double t =
      glm::dot(scaled, triangle.position[0] - ray.origin) / glm::dot(scaled, ray.direction);
  surface.position = ray.origin + t * ray.direction;
  surface.distance_m = glm::length(surface.position - ray.view_origin);

  const glm::dvec3 ap = surface.position - triangle.position[0];
  const double b = glm::dot(glm::cross(ap, ac), scaled) / glm::dot(scaled, scaled);
  const double c = glm::dot(glm::cross(ab, ap), scaled) / glm::dot(scaled, scaled);
  const double a = 1.0 - b - c;
  const glm::dvec3 flat = glm::normalize(scaled);
  const glm::dvec3 smooth =
      a * triangle.normal[0] + b * triangle.normal[1] + c * triangle.normal[2];
  const double side = glm::dot(flat, ray.direction) > 0.0 ? -1.0 : 1.0;
  surface.geometric_normal = side * flat;
  surface.shading_normal = surface.geometric_normal;
  if (glm::length(smooth) > 0.0) {
    const double smooth_side = glm::dot(smooth, surface.geometric_normal) < 0.0 ? -1.0 : 1.0;
    surface.shading_normal = smooth_side * glm::normalize(smooth);
  }
  surface.albedo = material.albedo;
  if (material.albedo_texture != scene::kNoTexture) {
    const glm::dvec2 uv = a * triangle.uv[0] + b * triangle.uv[1] + c * triangle.uv[2];
    surface.albedo *= scene::sample_texture(
        scene.textures[static_cast<std::size_t>(material.albedo_texture)], glm::vec2(uv));
  }
  return surface;
}

}  // namespace renderers::opengl

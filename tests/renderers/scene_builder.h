#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "renderers/renderer_list.h"
#include "renderers/scene/scene.h"

/// Scenes in code and renderings of them, for the tests of renderers.
namespace renderers::test {

scene::Material lambert(const glm::vec3& albedo, const glm::vec3& emission = glm::vec3(0.0F));
scene::Material phong(const glm::vec3& albedo, const glm::vec3& phong_albedo, float exponent);
scene::Material ggx(const glm::vec3& albedo, const glm::vec3& ggx_albedo, float alpha);

/// A scene under construction; every `add_...` returns an index.
struct SceneBuilder {
  scene::Scene scene;

  int add_material(const scene::Material& material);
  /// Parallelogram corner, +a, +a+b, +b: its front side shows along cross(a, b). uv = (a, b).
  int add_quad(const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b, int material);
  /// Axis-aligned box. @param inward  the front sides look into the box
  void add_box(const glm::vec3& low, const glm::vec3& high, int material, bool inward);
  /// Sphere of latitude-longitude triangles with smooth normals, front outside.
  int add_sphere(const glm::vec3& center, float radius, int segments, int material);
  void add_point_light(const glm::vec3& position, const glm::vec3& intensity);
  /// @param radiance  of every direction
  void set_environment(const glm::vec3& radiance);
  void look(const glm::vec3& from, const glm::vec3& at, float vertical_fov_deg);
};

/// How to render: parameters as "name=value", size, samples, seed, threads.
struct RenderRequest {
  std::string renderer = "path";
  std::vector<std::string> settings{};
  int width_px = 16;
  int height_px = 16;
  std::int64_t samples = 64;
  std::uint64_t seed = 1;
  int threads = 0;
  std::function<void(RenderJob&)> change_job{};
};

base::Parameters parameters_of(const std::string& renderer,
                               const std::vector<std::string>& settings);

/// prepare + render. @param timer  receives the stages if not null
Frame render(const scene::Scene& scene, const RenderRequest& request, StageTimer* timer = nullptr);

const perception::Image& aov(const Frame& frame, const std::string& name);
double counter(const Frame& frame, const std::string& name);

/// Mean over all values of an image.
double mean_of(const perception::Image& image);

/// Mean of an image and the standard deviation of that mean, per channel.
struct Mean {
  std::array<double, 3> value{};
  std::array<double, 3> sigma{};
};

/// From the variance AOV; pixels are independent of each other.
Mean mean_of(const Frame& frame);

/// True if the two agree within `sigmas` of their joint error, in every channel, and the joint
/// error is below `precision` of the value: a test without power does not pass.
bool agree(const Mean& a, const Mean& b, double precision, double sigmas = 4.5);
/// Against a known value, same in all channels.
bool agree(const Mean& a, double expected, double precision, double sigmas = 4.5);

std::string to_string(const Mean& mean);

}  // namespace renderers::test

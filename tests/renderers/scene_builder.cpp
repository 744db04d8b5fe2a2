#include "tests/renderers/scene_builder.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "perception/base/parameter_spec.h"

namespace renderers::test {

namespace {

constexpr float kPi = 3.14159265F;

int add_object(scene::Scene& scene, scene::Mesh mesh, int material) {
  scene::Object object;
  object.name = fmt::format("object{}", scene.objects.size());
  object.mesh = std::make_shared<const scene::Mesh>(std::move(mesh));
  object.material = material;
  scene.objects.push_back(std::move(object));
  return static_cast<int>(scene.objects.size()) - 1;
}

}  // namespace

scene::Material lambert(const glm::vec3& albedo, const glm::vec3& emission) {
  scene::Material material;
  material.albedo = albedo;
  material.emission = emission;
  return material;
}

scene::Material phong(const glm::vec3& albedo, const glm::vec3& phong_albedo, float exponent) {
  scene::Material material;
  material.albedo = albedo;
  material.lobe.albedo = phong_albedo;
  material.lobe.exponent = exponent;
  return material;
}

scene::Material ggx(const glm::vec3& albedo, const glm::vec3& ggx_albedo, float alpha) {
  scene::Material material;
  material.albedo = albedo;
  material.lobe = {ggx_albedo, scene::LobeShape::ggx, 0.0F, alpha};
  return material;
}

int SceneBuilder::add_material(const scene::Material& material) {
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

int SceneBuilder::add_quad(const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b,
                           int material) {
  scene::Mesh mesh;
  mesh.positions = {corner, corner + a, corner + a + b, corner + b};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return add_object(scene, std::move(mesh), material);
}

void SceneBuilder::add_box(const glm::vec3& low, const glm::vec3& high, int material, bool inward) {
  const glm::vec3 size = high - low;
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 a(0.0F);
    glm::vec3 b(0.0F);
    glm::vec3 along(0.0F);
    along[axis] = size[axis];
    a[(axis + 1) % 3] = size[(axis + 1) % 3];
    b[(axis + 2) % 3] = size[(axis + 2) % 3];
    // cross(a, b) points along +axis: inward at the low side.
    add_quad(low, inward ? a : b, inward ? b : a, material);
    add_quad(low + along, inward ? b : a, inward ? a : b, material);
  }
}

int SceneBuilder::add_sphere(const glm::vec3& center, float radius, int segments, int material) {
  scene::Mesh mesh;
  for (int row = 0; row <= segments; ++row) {
    const float polar = kPi * static_cast<float>(row) / static_cast<float>(segments);
    for (int column = 0; column < 2 * segments; ++column) {
      const float azimuth = kPi * static_cast<float>(column) / static_cast<float>(segments);
      const glm::vec3 normal(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                             std::sin(polar) * std::cos(azimuth));
      mesh.positions.push_back(center + radius * normal);
      mesh.normals.push_back(normal);
    }
  }
  const auto columns = static_cast<unsigned>(2 * segments);
  for (unsigned row = 0; row < static_cast<unsigned>(segments); ++row) {
    for (unsigned column = 0; column < columns; ++column) {
      const unsigned a = row * columns + column;
      const unsigned b = row * columns + (column + 1) % columns;
      if (row > 0) mesh.triangles.push_back({a, a + columns, b});
      if (row + 1 < static_cast<unsigned>(segments)) {
        mesh.triangles.push_back({b, a + columns, b + columns});
      }
    }
  }
  return add_object(scene, std::move(mesh), material);
}

void SceneBuilder::add_point_light(const glm::vec3& position, const glm::vec3& intensity) {
  scene::Light light;
  light.position = position;
  light.intensity = intensity;
  scene.lights.push_back(light);
}

void SceneBuilder::set_environment(const glm::vec3& radiance) {
  auto environment = std::make_shared<scene::Environment>();
  environment->image = perception::make_rgb_image(8, 4, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < environment->image.pixels.size(); ++i) {
    environment->image.pixels[i] = radiance[static_cast<int>(i % 3)];
  }
  scene.environment = std::move(environment);
}

void SceneBuilder::look(const glm::vec3& from, const glm::vec3& at, float vertical_fov_deg) {
  const glm::vec3 forward = glm::normalize(at - from);
  const bool is_upright = std::fabs(forward.y) < 0.9F;
  scene.camera = {from, at, is_upright ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1), vertical_fov_deg};
}

base::Parameters parameters_of(const std::string& renderer,
                               const std::vector<std::string>& settings) {
  const RendererInfo& info = find_renderer(renderer, {});
  std::vector<base::ParameterSetting> parsed;
  for (const std::string& text : settings) parsed.push_back(base::parse_setting(text, "test"));
  return base::resolve_parameters(info.parameters, nullptr, parsed, renderer);
}

Frame render(const scene::Scene& scene, const RenderRequest& request, StageTimer* timer) {
  const RendererInfo& info = find_renderer(request.renderer, {});
  Devices devices;
  devices.threads = request.threads;
  const auto renderer = info.create(parameters_of(request.renderer, request.settings), devices);
  RenderJob job;
  job.width_px = request.width_px;
  job.height_px = request.height_px;
  job.camera = scene.camera;
  job.seed = request.seed;
  if (request.samples > 0) job.samples = request.samples;
  if (request.change_job) request.change_job(job);
  StageTimer own;
  StageTimer& used = timer ? *timer : own;
  used.set_phase(Phase::prepare);
  renderer->prepare(scene, used);
  used.set_phase(Phase::render);
  return renderer->render(job, used);
}

const perception::Image& aov(const Frame& frame, const std::string& name) {
  for (const auto& image : frame.aovs) {
    if (image.name == name) return image.image;
  }
  throw std::runtime_error("no AOV " + name);
}

double counter(const Frame& frame, const std::string& name) {
  for (const auto& [key, value] : frame.counters) {
    if (key == name) return std::get<double>(value);
  }
  throw std::runtime_error("no counter " + name);
}

double mean_of(const perception::Image& image) {
  double sum = 0.0;
  for (const float value : image.pixels) sum += static_cast<double>(value);
  return sum / static_cast<double>(image.pixels.size());
}

Mean mean_of(const Frame& frame) {
  const perception::Image& variance = aov(frame, "variance");
  const auto count = static_cast<double>(frame.radiance.pixel_count());
  Mean mean;
  for (std::size_t i = 0; i < frame.radiance.pixels.size(); ++i) {
    mean.value[i % 3] += static_cast<double>(frame.radiance.pixels[i]) / count;
    mean.sigma[i % 3] += static_cast<double>(variance.pixels[i]) / (count * count);
  }
  for (double& sigma : mean.sigma) sigma = std::sqrt(sigma);
  return mean;
}

bool agree(const Mean& a, const Mean& b, double precision, double sigmas) {
  for (std::size_t c = 0; c < 3; ++c) {
    const double sigma = std::hypot(a.sigma[c], b.sigma[c]);
    // Floats limit what a noise-free image can agree to.
    const double rounding = 2e-6 * std::fabs(b.value[c]);
    if (!(sigma <= precision * std::fabs(b.value[c]) + rounding)) return false;
    if (!(std::fabs(a.value[c] - b.value[c]) <= sigmas * sigma + rounding)) return false;
  }
  return true;
}

bool agree(const Mean& a, double expected, double precision, double sigmas) {
  Mean known;
  known.value.fill(expected);
  return agree(a, known, precision, sigmas);
}

std::string to_string(const Mean& mean) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) +- ({:.2g}, {:.2g}, {:.2g})", mean.value[0],
                     mean.value[1], mean.value[2], mean.sigma[0], mean.sigma[1], mean.sigma[2]);
}

}  // namespace renderers::test

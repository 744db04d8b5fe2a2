#include "tests/renderers/many_lights/gl_fixture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "renderers/opengl/gpu_scene.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::test {

namespace {

void write(const opengl::Texture& texture, const std::vector<glm::vec4>& texels) {
  std::vector<float> values;
  for (const glm::vec4& texel : texels) values.insert(values.end(), &texel.x, &texel.x + 4);
  // Geometry buffers are written by drawing only; their textures are no constants.
  const_cast<opengl::Texture&>(texture).write(values);
}

}  // namespace

many_lights::SurfaceImage empty_surfaces(int width_px, int height_px) {
  const auto pixels = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  const std::vector<glm::vec4> zeros(pixels, glm::vec4(0.0F));
  return {width_px, height_px, zeros, zeros, zeros, zeros};
}

void put_flat(many_lights::SurfaceImage& surfaces, std::size_t pixel, const glm::vec3& position,
              const glm::vec3& normal) {
  surfaces.position[pixel] = glm::vec4(position, 1.0F);
  surfaces.geometric_normal[pixel] = glm::vec4(normal, 0.0F);
  surfaces.shading_normal[pixel] = glm::vec4(normal, 0.0F);
  surfaces.albedo[pixel] = glm::vec4(1.0F, 1.0F, 1.0F, 0.0F);
}

std::unique_ptr<opengl::GeometryBuffer> geometry_of(std::shared_ptr<opengl::Context> context,
                                                    const many_lights::SurfaceImage& surfaces) {
  auto buffer = std::make_unique<opengl::GeometryBuffer>(std::move(context), surfaces.width_px,
                                                         surfaces.height_px);
  write(buffer->position(), surfaces.position);
  write(buffer->geometric_normal(), surfaces.geometric_normal);
  write(buffer->shading_normal(), surfaces.shading_normal);
  write(buffer->albedo(), surfaces.albedo);
  return buffer;
}

opengl::Texture texture_of(std::shared_ptr<opengl::Context> context, int width_px, int height_px,
                           const std::vector<glm::dvec3>& values) {
  opengl::Texture texture(
      std::move(context),
      {.format = opengl::TextureFormat::rgba32f, .width_px = width_px, .height_px = height_px});
  std::vector<float> texels;
  for (const glm::dvec3& value : values) {
    for (int c = 0; c < 3; ++c) texels.push_back(static_cast<float>(value[c]));
    texels.push_back(1.0F);
  }
  texture.write(texels);
  return texture;
}

std::vector<glm::vec3> read_rgb(const opengl::Texture& texture) {
  const std::vector<float> values = texture.read();
  std::vector<glm::vec3> rgb;
  for (std::size_t i = 0; i + 3 < values.size(); i += 4) {
    rgb.emplace_back(values[i], values[i + 1], values[i + 2]);
  }
  return rgb;
}

Picture gather_on_device(std::shared_ptr<opengl::Context> context,
                         const many_lights::SurfaceImage& surfaces,
                         const std::vector<many_lights::VirtualLight>& lights,
                         const opengl::GpuScene& scene, const GatherCall& call) {
  const auto geometry = geometry_of(context, surfaces);
  const auto buffer =
      opengl::Buffer::of(context, std::span<const many_lights::VirtualLight>(lights));
  many_lights::Gather gather(context);
  gather.begin(*geometry, call.settings);
  const auto count = static_cast<int>(lights.size());
  const int batch = call.batch > 0 ? call.batch : count;
  for (int first = 0; first < count; first += batch) {
    gather.add(*geometry, scene,
               {.lights = &buffer,
                .count = count,
                .first = first,
                .batch = std::min(batch, count - first)},
               call.settings, call.order);
  }
  Picture picture{read_rgb(gather.targets().irradiance), {}};
  if (call.settings.with_glossy) picture.glossy = read_rgb(gather.targets().glossy);
  return picture;
}

double Numbers::next() {
  return static_cast<double>(ray_tracing::hash_combine(1, count_++) >> 11) * 0x1p-53;
}

glm::dvec3 Numbers::direction() {
  const double z = between(-1.0, 1.0);
  const double azimuth_rad = between(0.0, 2.0 * std::numbers::pi);
  const double radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(azimuth_rad), radius * std::sin(azimuth_rad), z};
}

glm::dvec3 Numbers::in_box(double half_width) {
  const double x = between(-half_width, half_width);
  const double y = between(-half_width, half_width);
  return {x, y, between(-half_width, half_width)};
}

}  // namespace renderers::test

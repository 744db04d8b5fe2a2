#include "renderers/opengl/gpu_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "perception/base/parallel.h"
#include "renderers/opengl/gpu_stage.h"

namespace renderers::opengl {

namespace {

/// Triangles of one task of the parallel loop.
constexpr std::size_t kGrain = 2048;

/// What the triangles of an object have in common.
struct ObjectFrame {
  const scene::Mesh& mesh;
  glm::mat4 to_world;
  glm::mat3 normal_to_world;  ///< inverse transpose
  bool mirrors = false;       ///< counter-clockwise triangles become clockwise
  float material_bits = 0.0F;
};

ObjectFrame frame_of(const scene::Object& object) {
  const glm::mat3 linear(object.to_world);
  return {*object.mesh, object.to_world, glm::transpose(glm::inverse(linear)),
          glm::determinant(linear) < 0.0F, std::bit_cast<float>(object.material)};
}

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The corner's normal in world space; the flat one if the mesh has none there.
glm::vec3 corner_normal(const ObjectFrame& frame, std::uint32_t vertex, const glm::vec3& flat) {
  if (frame.mesh.normals.empty()) return flat;
  const glm::vec3 normal = glm::normalize(frame.normal_to_world * frame.mesh.normals[vertex]);
  return is_finite(normal) ? normal : flat;
}

/// As in ray_tracing::RayScene. A triangle without area has the normal 0 and covers no pixel.
GpuTriangle world_triangle(const ObjectFrame& frame, glm::uvec3 index) {
  if (frame.mirrors) std::swap(index.y, index.z);
  glm::vec3 position[3];
  for (glm::length_t corner = 0; corner < 3; ++corner) {
    position[corner] =
        glm::vec3(frame.to_world * glm::vec4(frame.mesh.positions[index[corner]], 1.0F));
  }
  const glm::vec3 scaled = glm::cross(position[1] - position[0], position[2] - position[0]);
  const glm::vec3 normalized = glm::normalize(scaled);
  const glm::vec3 flat = is_finite(normalized) ? normalized : glm::vec3(0.0F);

  GpuTriangle triangle;
  for (glm::length_t corner = 0; corner < 3; ++corner) {
    const std::uint32_t vertex = index[corner];
    const glm::vec2 uv = frame.mesh.uvs.empty() ? glm::vec2(0.0F) : frame.mesh.uvs[vertex];
    triangle.position[corner] = glm::vec4(position[corner], uv.x);
    triangle.normal[corner] = glm::vec4(corner_normal(frame, vertex, flat), uv.y);
  }
  triangle.geometric_normal = glm::vec4(flat, frame.material_bits);
  return triangle;
}

std::vector<GpuTriangle> world_triangles(const scene::Scene& scene) {
  std::vector<GpuTriangle> triangles(scene.face_count());
  std::size_t first = 0;
  for (const scene::Object& object : scene.objects) {
    const ObjectFrame frame = frame_of(object);
    const std::size_t count = object.mesh->triangles.size();
    base::parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        triangles[first + i] = world_triangle(frame, object.mesh->triangles[i]);
      }
    });
    first += count;
  }
  return triangles;
}

scene::Box bounds_of(const std::vector<GpuTriangle>& triangles) {
  scene::Box box;
  for (const GpuTriangle& triangle : triangles) {
    for (const glm::vec4& corner : triangle.position) {
      box.least = glm::min(box.least, glm::vec3(corner));
      box.greatest = glm::max(box.greatest, glm::vec3(corner));
    }
  }
  return box;
}

bool any_object(const scene::Scene& scene, const std::function<bool(const scene::Material&)>& is) {
  return std::ranges::any_of(scene.objects, [&](const scene::Object& object) {
    return is(scene.materials[static_cast<std::size_t>(object.material)]);
  });
}

/// Where each texture of the scene begins among the texels, -1 for one no albedo uses.
struct TexelTable {
  std::vector<int> first;
  std::size_t count = 0;
};

TexelTable texel_table(const scene::Scene& scene) {
  TexelTable table;
  table.first.assign(scene.textures.size(), -1);
  for (const scene::Material& material : scene.materials) {
    if (material.albedo_texture == scene::kNoTexture) continue;
    const auto texture = static_cast<std::size_t>(material.albedo_texture);
    if (table.first[texture] >= 0) continue;
    table.first[texture] = static_cast<int>(table.count);
    const perception::Image& image = scene.textures[texture].image;
    table.count +=
        static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
  }
  return table;
}

std::vector<GpuMaterial> gpu_materials(const scene::Scene& scene, const TexelTable& table) {
  std::vector<GpuMaterial> materials;
  for (const scene::Material& material : scene.materials) {
    GpuMaterial& gpu = materials.emplace_back();
    const scene::GlossyLobe& lobe = material.lobe;
    gpu.lobe =
        glm::vec4(lobe.albedo, lobe.shape == scene::LobeShape::ggx ? -lobe.alpha : lobe.exponent);
    gpu.emission = glm::vec4(material.emission, 0.0F);
    gpu.texture_size = glm::ivec4(0);
    int first = -1;
    if (material.albedo_texture != scene::kNoTexture) {
      const auto texture = static_cast<std::size_t>(material.albedo_texture);
      const perception::Image& image = scene.textures[texture].image;
      first = table.first[texture];
      gpu.texture_size = {image.width_px, image.height_px, 0, 0};
    }
    gpu.albedo = glm::vec4(material.albedo, std::bit_cast<float>(first));
  }
  return materials;
}

/// Of the texels that the table lists, with their sizes and places.
base::Hash texel_hash(const scene::Scene& scene, const TexelTable& table) {
  base::Hasher hasher;
  for (std::size_t texture = 0; texture < table.first.size(); ++texture) {
    if (table.first[texture] < 0) continue;
    const perception::Image& image = scene.textures[texture].image;
    hasher.add(std::int64_t{table.first[texture]});
    hasher.add(std::int64_t{image.width_px});
    hasher.add(std::span<const float>(image.pixels));
  }
  return hasher.finish();
}

std::vector<glm::vec4> gpu_texels(const scene::Scene& scene, const TexelTable& table) {
  std::vector<glm::vec4> texels(table.count, glm::vec4(0.0F));
  for (std::size_t texture = 0; texture < table.first.size(); ++texture) {
    if (table.first[texture] < 0) continue;
    const perception::Image& image = scene.textures[texture].image;
    auto texel = texels.begin() + table.first[texture];
    for (int y = 0; y < image.height_px; ++y) {
      for (int x = 0; x < image.width_px; ++x) {
        const auto rgb = image.pixel(x, y);
        *texel++ = {rgb[0], rgb[1], rgb[2], 0.0F};
      }
    }
  }
  return texels;
}

/// Writes the elements into a buffer that is kept if they fit.
template <typename Element>
void upload(const std::shared_ptr<Context>& context, const std::vector<Element>& elements,
            Buffer& buffer) {
  buffer.reserve(context, std::max<std::size_t>(1, elements.size()) * sizeof(Element));
  buffer.write(std::span<const Element>(elements));
}

void check_size(const Context& context, std::size_t size_bytes, const char* what) {
  const std::int64_t limit_bytes = context.limits().storage_block_bytes;
  if (static_cast<std::int64_t>(size_bytes) <= limit_bytes) return;
  throw UnsupportedError(fmt::format("the scene's {} take {} bytes in one block; {} allows {}",
                                     what, size_bytes, context.facts().renderer, limit_bytes));
}

}  // namespace

GpuScene::GpuScene(std::shared_ptr<Context> context) : context_(std::move(context)) {}

void GpuScene::load(const scene::Scene& scene, StageTimer& timer) {
  const TexelTable table = texel_table(scene);
  check_size(*context_, scene.face_count() * sizeof(GpuTriangle), "triangles");
  check_size(*context_, table.count * sizeof(glm::vec4), "textures");
  std::vector<GpuTriangle> triangles;
  std::vector<GpuMaterial> materials;
  {
    auto stage = timer.stage("triangles");
    triangles = world_triangles(scene);
    materials = gpu_materials(scene, table);
    bounds_ = bounds_of(triangles);
    stage.add_bytes(static_cast<std::int64_t>(triangles.size() * sizeof(GpuTriangle)));
  }
  triangle_count_ = static_cast<int>(triangles.size());
  has_glossy_ = any_object(scene, [](const scene::Material& m) { return m.is_glossy(); });
  has_ggx_ = any_object(scene, [](const scene::Material& m) {
    return m.is_glossy() && m.lobe.shape == scene::LobeShape::ggx;
  });

  GpuStage stage(*context_, timer, "upload");
  upload(context_, triangles, triangles_);
  upload(context_, materials, materials_);
  const base::Hash hash = texel_hash(scene, table);
  if (texels_.id() == 0 || hash != texel_hash_) {
    upload(context_, gpu_texels(scene, table), texels_);
    texel_hash_ = hash;
  }
  context_->check("uploading the scene");
  stage.add_bytes(0, memory_bytes());
}

std::int64_t GpuScene::memory_bytes() const {
  return static_cast<std::int64_t>(triangles_.size_bytes() + materials_.size_bytes() +
                                   texels_.size_bytes());
}

}  // namespace renderers::opengl

#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "renderers/opengl/buffer.h"
#include "renderers/opengl/context.h"
#include "renderers/opengl/shader_source.h"
#include "renderers/opengl/texture.h"

namespace renderers::opengl {

enum class Access { read, write, read_write };

/// Work groups of a local size that cover so many items.
constexpr std::uint32_t groups_for(std::int64_t items, std::int64_t local_size) {
  return static_cast<std::uint32_t>((items + local_size - 1) / local_size);
}

/// Numbers of a draw in a buffer, std430.
struct DrawCommand {
  std::uint32_t vertex_count = 0;
  std::uint32_t instances = 0;
  std::uint32_t first_vertex = 0;
  std::uint32_t first_instance = 0;  ///< vertex attributes only: gl_InstanceID starts at 0
};

/// A compiled and linked program; made by `Context::program` and kept there. Bindings are the
/// numbers of the shaders' `layout(binding = n)`.
class Program {
 public:
  Program(Context& context, const ProgramSource& source);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Uniforms by name; a name that the linker removed is ignored, one that no file spells is a
  /// mistake of ours (assert).
  void set(const std::string& name, int value);
  void set(const std::string& name, std::uint32_t value);
  void set(const std::string& name, float value);
  void set(const std::string& name, const glm::ivec2& value);
  void set(const std::string& name, const glm::vec2& value);
  void set(const std::string& name, const glm::vec3& value);
  void set(const std::string& name, const glm::vec4& value);
  void set(const std::string& name, const glm::mat4& value);

  void storage(std::uint32_t binding, const Buffer& buffer);
  void sampler(std::uint32_t binding, const Texture& texture);
  /// The whole level, every layer.
  void image(std::uint32_t binding, const Texture& texture, Access access, int level = 0);

  /// Runs a compute program; everything it wrote is visible to what follows.
  void dispatch(std::uint32_t groups_x, std::uint32_t groups_y = 1, std::uint32_t groups_z = 1);
  /// Draws without vertex attributes into the bound framebuffer (gl_VertexID pulls from storage);
  /// everything it wrote is visible to what follows.
  void draw_triangles(int first_vertex, int vertex_count, int instances = 1);
  /// The same with numbers that the device made. @param index  of the command in the buffer
  void draw_triangles(const Buffer& commands, int index);
  /// The same, gl_VertexID from 32-bit indices: vertices that triangles share are made once.
  void draw_indexed_triangles(const Buffer& indices, int vertex_count, int instances);
  /// Draws points of a pixel each.
  void draw_points(int count);

 private:
  int location(const std::string& name);

  Context& context_;
  std::uint32_t id_ = 0;
  std::string text_;  ///< of all stages, expanded
  std::unordered_map<std::string, int> locations_;
};

}  // namespace renderers::opengl

#include "renderers/opengl/program.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/core.h>
#include <glm/gtc/type_ptr.hpp>

#include "perception/base/errors.h"
#include "renderers/opengl/gl_functions.h"
#include "renderers/opengl/texture_format.h"

namespace renderers::opengl {

namespace {

GLenum stage_of(const std::string& path) {
  if (path.ends_with(".vert.glsl")) return GL_VERTEX_SHADER;
  if (path.ends_with(".geom.glsl")) return GL_GEOMETRY_SHADER;
  if (path.ends_with(".frag.glsl")) return GL_FRAGMENT_SHADER;
  assert(path.ends_with(".comp.glsl"));
  return GL_COMPUTE_SHADER;
}

std::string shader_log(const Functions& gl, GLuint shader) {
  GLint length = 0;
  gl.GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  gl.GetShaderInfoLog(shader, length, &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return log;
}

std::string program_log(const Functions& gl, GLuint program) {
  GLint length = 0;
  gl.GetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  gl.GetProgramInfoLog(program, length, &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return log;
}

/// A compiled shader of a stage; deleted with this.
class Shader {
 public:
  Shader(const Functions& gl, const std::string& path, const ExpandedShader& source)
      : gl_(gl), id_(gl.CreateShader(stage_of(path))) {
    const GLchar* text = source.text.c_str();
    gl_.ShaderSource(id_, 1, &text, nullptr);
    gl_.CompileShader(id_);
    GLint is_compiled = 0;
    gl_.GetShaderiv(id_, GL_COMPILE_STATUS, &is_compiled);
    if (is_compiled != 0) return;
    const std::string log = readable_log(shader_log(gl_, id_), source.files);
    gl_.DeleteShader(id_);
    throw base::DeviceError(fmt::format("shader {} does not compile:\n{}", path, log));
  }
  ~Shader() { gl_.DeleteShader(id_); }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
  GLuint id() const { return id_; }

 private:
  const Functions& gl_;
  GLuint id_;
};

GLenum access_of(Access access) {
  switch (access) {
    case Access::read:
      return GL_READ_ONLY;
    case Access::write:
      return GL_WRITE_ONLY;
    case Access::read_write:
      break;
  }
  return GL_READ_WRITE;
}

}  // namespace

Program::Program(Context& context, const ProgramSource& source) : context_(context) {
  assert(!source.stages.empty());
  const Functions& gl = context_.use();
  std::vector<std::unique_ptr<Shader>> shaders;
  try {
    for (const std::string& path : source.stages) {
      const ExpandedShader expanded = expand_shader(source, path);
      shaders.push_back(std::make_unique<Shader>(gl, path, expanded));
      text_ += expanded.text;
    }
  } catch (const base::DeviceError&) {
    context_.take_messages();  // the log is in the exception
    throw;
  }
  id_ = gl.CreateProgram();
  for (const auto& shader : shaders) gl.AttachShader(id_, shader->id());
  gl.LinkProgram(id_);
  for (const auto& shader : shaders) gl.DetachShader(id_, shader->id());
  GLint is_linked = 0;
  gl.GetProgramiv(id_, GL_LINK_STATUS, &is_linked);
  if (is_linked != 0) return;
  const std::string log = program_log(gl, id_);
  gl.DeleteProgram(id_);
  context_.take_messages();
  throw base::DeviceError(
      fmt::format("the program of shader {} does not link:\n{}", source.stages.front(), log));
}

Program::~Program() { context_.use().DeleteProgram(id_); }

int Program::location(const std::string& name) {
  const auto [found, is_new] = locations_.try_emplace(name, -1);
  if (is_new) {
    found->second = context_.use().GetUniformLocation(id_, name.c_str());
    assert(found->second >= 0 || text_.find(name.substr(0, name.find('['))) != std::string::npos);
  }
  return found->second;
}

void Program::set(const std::string& name, int value) {
  context_.use().ProgramUniform1i(id_, location(name), value);
}
void Program::set(const std::string& name, std::uint32_t value) {
  context_.use().ProgramUniform1ui(id_, location(name), value);
}
void Program::set(const std::string& name, float value) {
  context_.use().ProgramUniform1f(id_, location(name), value);
}
void Program::set(const std::string& name, const glm::ivec2& value) {
  context_.use().ProgramUniform2iv(id_, location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::vec2& value) {
  context_.use().ProgramUniform2fv(id_, location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::vec3& value) {
  context_.use().ProgramUniform3fv(id_, location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::vec4& value) {
  context_.use().ProgramUniform4fv(id_, location(name), 1, glm::value_ptr(value));
}
void Program::set(const std::string& name, const glm::mat4& value) {
  context_.use().ProgramUniformMatrix4fv(id_, location(name), 1, GL_FALSE, glm::value_ptr(value));
}

void Program::storage(std::uint32_t binding, const Buffer& buffer) {
  assert(buffer.id() != 0);
  context_.use().BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id());
}

void Program::sampler(std::uint32_t binding, const Texture& texture) {
  assert(!texture.is_empty());
  context_.use().BindTextureUnit(binding, texture.id());
}

void Program::image(std::uint32_t binding, const Texture& texture, Access access, int level) {
  const TextureShape& shape = texture.shape();
  assert(!texture.is_empty() && shape.format != TextureFormat::depth32f);
  assert(static_cast<std::int64_t>(binding) < context_.limits().image_units);
  context_.use().BindImageTexture(binding, texture.id(), level,
                                  shape.layers > 0 ? GL_TRUE : GL_FALSE, 0, access_of(access),
                                  format_facts(shape.format).internal);
}

void Program::dispatch(std::uint32_t groups_x, std::uint32_t groups_y, std::uint32_t groups_z) {
  assert(std::max({groups_x, groups_y, groups_z}) <= context_.limits().work_groups);
  const Functions& gl = context_.use();
  gl.UseProgram(id_);
  gl.DispatchCompute(groups_x, groups_y, groups_z);
  gl.MemoryBarrier(GL_ALL_BARRIER_BITS);
}

void Program::draw_triangles(int first_vertex, int vertex_count, int instances) {
  const Functions& gl = context_.use();
  gl.UseProgram(id_);
  gl.DrawArraysInstanced(GL_TRIANGLES, first_vertex, vertex_count, instances);
  gl.MemoryBarrier(GL_ALL_BARRIER_BITS);
}

void Program::draw_triangles(const Buffer& commands, int index) {
  const Functions& gl = context_.use();
  gl.UseProgram(id_);
  gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.id());
  const auto offset_bytes = static_cast<std::uintptr_t>(index) * sizeof(DrawCommand);
  gl.DrawArraysIndirect(GL_TRIANGLES, reinterpret_cast<const void*>(offset_bytes));
  gl.BindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
  gl.MemoryBarrier(GL_ALL_BARRIER_BITS);
}

void Program::draw_indexed_triangles(const Buffer& indices, int vertex_count, int instances) {
  const Functions& gl = context_.use();
  gl.UseProgram(id_);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.id());
  gl.DrawElementsInstanced(GL_TRIANGLES, vertex_count, GL_UNSIGNED_INT, nullptr, instances);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
  gl.MemoryBarrier(GL_ALL_BARRIER_BITS);
}

void Program::draw_points(int count) {
  const Functions& gl = context_.use();
  gl.UseProgram(id_);
  gl.DrawArraysInstanced(GL_POINTS, 0, count, 1);
  gl.MemoryBarrier(GL_ALL_BARRIER_BITS);
}

}  // namespace renderers::opengl

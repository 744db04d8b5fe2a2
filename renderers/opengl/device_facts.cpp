#include "renderers/opengl/device_facts.h"

#include <algorithm>
#include <array>

#include "renderers/opengl/gl_functions.h"

namespace renderers::opengl {

namespace {

/// True for Mesa's rasterisers on the CPU.
bool is_software_renderer(const std::string& renderer) {
  const std::array<const char*, 4> names{"llvmpipe", "softpipe", "SWR", "Software Rasterizer"};
  return std::ranges::any_of(
      names, [&](const char* name) { return renderer.find(name) != std::string::npos; });
}

std::string text_of(const Functions& gl, GLenum name) {
  const auto* text = reinterpret_cast<const char*>(gl.GetString(name));
  return text == nullptr ? "" : text;
}

std::int64_t integer_of(const Functions& gl, GLenum name) {
  GLint value = 0;
  gl.GetIntegerv(name, &value);
  return value;
}

bool has_extension(const Functions& gl, const std::string& name) {
  const auto count = static_cast<GLuint>(integer_of(gl, GL_NUM_EXTENSIONS));
  for (GLuint i = 0; i < count; ++i) {
    const auto* text = reinterpret_cast<const char*>(gl.GetStringi(GL_EXTENSIONS, i));
    if (text != nullptr && name == text) return true;
  }
  return false;
}

std::int64_t least_work_groups(const Functions& gl) {
  std::array<GLint, 3> counts{};
  for (GLuint axis = 0; axis < 3; ++axis) {
    gl.GetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, axis, &counts[axis]);
  }
  return *std::ranges::min_element(counts);
}

}  // namespace

void require_version(const Functions& gl) {
  const std::int64_t version =
      10 * integer_of(gl, GL_MAJOR_VERSION) + integer_of(gl, GL_MINOR_VERSION);
  if (version < 45) {
    throw UnsupportedError("OpenGL 4.5 is needed, the context has " + text_of(gl, GL_VERSION));
  }
}

Limits limits_of(const Functions& gl) {
  Limits limits;
  limits.texture_size_px = integer_of(gl, GL_MAX_TEXTURE_SIZE);
  limits.array_layers = integer_of(gl, GL_MAX_ARRAY_TEXTURE_LAYERS);
  limits.storage_block_bytes = integer_of(gl, GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
  limits.storage_blocks = integer_of(gl, GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS);
  limits.vertex_storage_blocks = integer_of(gl, GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS);
  limits.fragment_storage_blocks = integer_of(gl, GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS);
  limits.storage_bindings = integer_of(gl, GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
  limits.work_group_invocations = integer_of(gl, GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
  limits.work_groups = least_work_groups(gl);
  limits.shared_memory_bytes = integer_of(gl, GL_MAX_COMPUTE_SHARED_MEMORY_SIZE);
  limits.image_units = integer_of(gl, GL_MAX_IMAGE_UNITS);
  limits.has_vertex_layers = has_extension(gl, "GL_ARB_shader_viewport_layer_array");
  return limits;
}

DeviceFacts facts_of(const Functions& gl, const std::string& platform, const Limits& limits) {
  DeviceFacts facts;
  facts.platform = platform;
  facts.renderer = text_of(gl, GL_RENDERER);
  facts.vendor = text_of(gl, GL_VENDOR);
  facts.version = text_of(gl, GL_VERSION);
  facts.is_software = is_software_renderer(facts.renderer);
  const auto add = [&](const char* name, std::int64_t value) {
    facts.limits.emplace_back(name, static_cast<double>(value));
  };
  add("max_texture_size_px", limits.texture_size_px);
  add("max_array_layers", limits.array_layers);
  add("max_storage_block_bytes", limits.storage_block_bytes);
  add("max_storage_blocks", limits.storage_blocks);
  add("max_vertex_storage_blocks", limits.vertex_storage_blocks);
  add("max_fragment_storage_blocks", limits.fragment_storage_blocks);
  add("max_storage_bindings", limits.storage_bindings);
  add("max_work_group_invocations", limits.work_group_invocations);
  add("max_work_groups", limits.work_groups);
  add("max_shared_memory_bytes", limits.shared_memory_bytes);
  add("max_image_units", limits.image_units);
  return facts;
}

}  // namespace renderers::opengl

#pragma once

#include <compare>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace renderers::opengl {

/// A shader file as embedded when the program was built.
struct ShaderFile {
  std::string_view
      path;  ///< from the repository root: "renderers/opengl/shaders/geometry.vert.glsl"
  std::string_view text;
};

/// Names of `#define`s and their values.
using Defines = std::vector<std::pair<std::string, std::string>>;

/// What a program is made of: one compute shader, or a vertex and a fragment shader, a
/// geometry shader between them if need be.
struct ProgramSource {
  std::span<const ShaderFile> files;  ///< those named below and all they include
  std::vector<std::string> stages;    ///< paths; the stage is in the name: .vert .geom .frag .comp
  Defines defines{};
};

/// A shader's text with its `#include "root/relative/path"` lines replaced by the files' texts,
/// each file once, `#version 450 core` and the defines first, `#line` directives throughout.
struct ExpandedShader {
  std::string text;
  std::vector<std::string> files;  ///< by the source-string number of the #line directives
};

/// Files are read below the folder $DISCERN_SHADERS if it is set (a checkout's root), so that
/// shaders can be changed without a build; else from `source.files`.
/// @throws base::InputError for a missing file or an include cycle, naming the including line
ExpandedShader expand_shader(const ProgramSource& source, const std::string& path);

/// A driver's log with "file:line" instead of source-string numbers, for Mesa's ("0:12(3): error")
/// and NVIDIA's ("0(12) : error") forms.
std::string readable_log(const std::string& log, const std::vector<std::string>& files);

}  // namespace renderers::opengl

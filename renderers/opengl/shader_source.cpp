#include "renderers/opengl/shader_source.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>

#include <fmt/core.h>

#include "perception/base/errors.h"

namespace renderers::opengl {

namespace {

/// Where the texts of shader files come from.
class ShaderFolder {
 public:
  explicit ShaderFolder(std::span<const ShaderFile> embedded) : embedded_(embedded) {
    const char* root = std::getenv("DISCERN_SHADERS");
    if (root != nullptr && *root != '\0') root_ = root;
  }

  /// @param place  where the file is asked for
  std::string text_of(const std::string& path, const base::Place& place) const {
    return root_ ? text_on_disk(path, place) : embedded_text(path, place);
  }

 private:
  std::string text_on_disk(const std::string& path, const base::Place& place) const {
    const std::string name = *root_ + "/" + path;
    std::ifstream file(name, std::ios::binary);
    std::ostringstream text;
    if (!file || !(text << file.rdbuf())) {
      throw base::InputError(
          place, fmt::format("cannot read the shader file \"{}\" (DISCERN_SHADERS is set)", name));
    }
    return text.str();
  }

  std::string embedded_text(const std::string& path, const base::Place& place) const {
    for (const ShaderFile& file : embedded_) {
      if (file.path == path) return std::string(file.text);
    }
    std::string known;
    for (const ShaderFile& file : embedded_) {
      known += (known.empty() ? "" : ", ") + std::string(file.path);
    }
    throw base::InputError(
        place, fmt::format("no shader file \"{}\" is embedded; known: {}", path, known));
  }

  std::span<const ShaderFile> embedded_;
  std::optional<std::string> root_;
};

/// The path of a line `#include "path"`.
std::optional<std::string> include_of(const std::string& line) {
  static const std::regex kPattern(R"re(^\s*#\s*include\s*"([^"]+)"\s*(//.*)?$)re");
  std::smatch match;
  if (line.find("include") == std::string::npos || !std::regex_match(line, match, kPattern)) {
    return std::nullopt;
  }
  return match[1];
}

class Expansion {
 public:
  explicit Expansion(std::span<const ShaderFile> embedded) : folder_(embedded) {}

  void add(const std::string& path, const base::Place& place) {
    if (std::ranges::find(open_, path) != open_.end()) {
      std::string circle;
      for (const std::string& each : open_) circle += each + " > ";
      throw base::InputError(
          place, fmt::format("shader files include each other in a circle: {}{}", circle, path));
    }
    std::istringstream lines(folder_.text_of(path, place));
    const std::size_t number = shader_.files.size();
    shader_.files.push_back(path);
    open_.push_back(path);
    shader_.text += fmt::format("#line 1 {}\n", number);
    std::string line;
    for (int line_number = 1; std::getline(lines, line); ++line_number) {
      add_line(line, {path, line_number, 0}, number);
    }
    open_.pop_back();
  }

  ExpandedShader shader_;

 private:
  void add_line(const std::string& line, const base::Place& place, std::size_t file_number) {
    const auto include = include_of(line);
    if (!include) {
      shader_.text += line + "\n";
      return;
    }
    const bool is_open = std::ranges::find(open_, *include) != open_.end();
    const bool is_done = std::ranges::find(shader_.files, *include) != shader_.files.end();
    if (is_open || !is_done) add(*include, place);
    shader_.text += fmt::format("#line {} {}\n", place.line + 1, file_number);
  }

  ShaderFolder folder_;
  std::vector<std::string> open_;  ///< the file being read and those that include it
};

}  // namespace

ExpandedShader expand_shader(const ProgramSource& source, const std::string& path) {
  Expansion expansion(source.files);
  expansion.shader_.text = "#version 450 core\n";
  for (const auto& [name, value] : source.defines) {
    expansion.shader_.text += fmt::format("#define {} {}\n", name, value);
  }
  expansion.add(path, {});
  return std::move(expansion.shader_);
}

std::string readable_log(const std::string& log, const std::vector<std::string>& files) {
  // Mesa "0:12(3): error: ...", NVIDIA "0(12) : error C1503: ...".
  static const std::regex kMesa(R"re(^(\d+):(\d+)\((\d+)\):)re");
  static const std::regex kNvidia(R"re(^(\d+)\((\d+)\)\s*:)re");
  std::istringstream lines(log);
  std::string readable;
  std::string line;
  while (std::getline(lines, line)) {
    std::smatch match;
    const bool is_mesa = std::regex_search(line, match, kMesa);
    if (is_mesa || std::regex_search(line, match, kNvidia)) {
      const std::size_t number = std::stoul(match[1]);
      if (number < files.size()) {
        const int column = is_mesa ? std::stoi(match[3]) : 0;
        line = base::to_string({files[number], std::stoi(match[2]), column}) + ":" +
               match.suffix().str();
      }
    }
    readable += (readable.empty() ? "" : "\n") + line;
  }
  return readable;
}

}  // namespace renderers::opengl

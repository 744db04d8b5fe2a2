#pragma once

#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace suites::command_line {

/// A file of schemas/, embedded at build.
struct EmbeddedSchema {
  std::string_view name;  ///< "render"
  std::string_view text;
};

/// All of them, sorted by name. Generated: embed_schemas.cmake.
std::span<const EmbeddedSchema> embedded_schemas();

/// A schema as one self-contained JSON Schema (draft 2020-12): {"$include": "x"} stands for the
/// whole schema x. Names match up to `-` and `_`.
/// @throws base::InputError with the nearest known name
nlohmann::ordered_json schema(const std::string& name);

}  // namespace suites::command_line

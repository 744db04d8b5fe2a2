#include "suites/command_line/schemas.h"

#include <vector>

#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/names.h"

namespace suites::command_line {

using nlohmann::ordered_json;

namespace {

void resolve_includes(ordered_json& json) {
  if (json.is_object() && json.contains("$include")) {
    ordered_json included = schema(json["$include"].get<std::string>());
    included.erase("$schema");
    json = std::move(included);
    return;
  }
  if (!json.is_structured()) return;
  for (ordered_json& child : json) resolve_includes(child);
}

}  // namespace

ordered_json schema(const std::string& name) {
  std::vector<std::string> known;
  for (const EmbeddedSchema& embedded : embedded_schemas()) {
    known.emplace_back(embedded.name);
    if (!base::is_same_name(embedded.name, name)) continue;
    ordered_json json = ordered_json::parse(embedded.text);
    resolve_includes(json);
    return json;
  }
  throw base::InputError({"discern schema"}, base::unknown_name("schema", name, known));
}

}  // namespace suites::command_line

#include "results/html_report/json_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/json_fields.h"

namespace results::html_report {

using nlohmann::ordered_json;

std::string text_of(const ordered_json& json) {
  if (json.is_null()) return "";
  if (json.is_string()) return json.get<std::string>();
  if (json.is_number_float()) return fmt::format("{}", json.get<double>());
  if (!json.is_structured()) return to_line(json);
  std::string text;
  for (const auto& [key, value] : json.items()) {
    if (!text.empty()) text += ", ";
    text += json.is_object() ? key + " " + text_of(value) : text_of(value);
  }
  return text;
}

std::string text_at(const ordered_json& json, std::initializer_list<const char*> keys) {
  const ordered_json* value = &json;
  for (const char* key : keys) {
    if (!value->is_object()) return "";
    const auto found = value->find(key);
    if (found == value->end()) return "";
    value = &*found;
  }
  return text_of(*value);
}

}  // namespace results::html_report

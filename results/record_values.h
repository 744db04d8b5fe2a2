#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "results/json_fields.h"
#include "results/run_record.h"

/// What the records of run_record.h share on their way to and from JSON; for this folder's .cpp
/// files only.
namespace results {

template <class Value>
nlohmann::ordered_json json_or_null(const std::optional<Value>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// A boolean, a number or a text; nothing for anything else.
std::optional<base::ParameterValue> parameter_from_json(const nlohmann::ordered_json& value);
nlohmann::ordered_json parameters_json(const ParameterValues& parameters);
/// @throws base::InputError unless the field is an object of booleans, numbers and texts
ParameterValues parameters_of(const JsonFields& fields, const char* key);

/// Everything of a RenderRecord from "status" on.
void write_fields(const RenderRecord& record, bool with_scene, nlohmann::ordered_json& json);
RenderRecord read_render_fields(const JsonFields& fields);

}  // namespace results

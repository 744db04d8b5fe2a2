#include "perception/base/parameter_spec.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/names.h"

namespace base {

namespace {

std::string to_string(ParameterType type) {
  switch (type) {
    case ParameterType::integer:
      return "int";
    case ParameterType::real:
      return "float";
    case ParameterType::boolean:
      return "bool";
    case ParameterType::choice:
      return "choice";
    case ParameterType::text:
      return "string";
  }
  return "string";
}

/// What a parameter accepts, for messages: "a whole number, 0 to 8 pixels".
std::string accepted_values(const ParameterSpec& spec) {
  if (spec.type == ParameterType::boolean) return "true or false";
  if (spec.type == ParameterType::choice) {
    return fmt::format("one of {}", fmt::join(spec.choices, ", "));
  }
  if (spec.type == ParameterType::text) return "text";
  std::string text = spec.type == ParameterType::integer ? "a whole number" : "a number";
  if (spec.min && spec.max) {
    text += fmt::format(" from {} to {}", *spec.min, *spec.max);
  } else if (spec.min) {
    text += fmt::format(" of at least {}", *spec.min);
  } else if (spec.max) {
    text += fmt::format(" of at most {}", *spec.max);
  }
  return spec.unit.empty() ? text : text + " (" + spec.unit + ")";
}

[[noreturn]] void refuse(const ParameterSpec& spec, const Node& value, const std::string& owner) {
  const std::string found = value.is_scalar() ? "\"" + value.scalar_text(spec.name) + "\""
                                              : Node::kind_name(value.kind());
  throw InputError(value.place(), fmt::format("parameter \"{}\" of {} cannot be {}; accepted: {}",
                                              spec.name, owner, found, accepted_values(spec)));
}

bool is_in_range(const ParameterSpec& spec, double value) {
  return std::isfinite(value) && (!spec.min || value >= *spec.min) &&
         (!spec.max || value <= *spec.max);
}

ParameterValue number_value(const ParameterSpec& spec, const Node& value,
                            const std::string& owner) {
  const bool wants_integer = spec.type == ParameterType::integer;
  const bool has_kind = wants_integer ? value.kind() == Node::Kind::integer : value.is_number();
  if (!has_kind || !is_in_range(spec, value.number(spec.name))) refuse(spec, value, owner);
  if (wants_integer) return value.integer(spec.name);
  return value.number(spec.name);
}

/// Reads a value as the type its specification asks for.
ParameterValue read_value(const ParameterSpec& spec, const Node& value, const std::string& owner) {
  switch (spec.type) {
    case ParameterType::integer:
    case ParameterType::real:
      return number_value(spec, value, owner);
    case ParameterType::boolean:
      if (value.kind() != Node::Kind::boolean) refuse(spec, value, owner);
      return value.boolean(spec.name);
    case ParameterType::text:
      if (!value.is_scalar()) refuse(spec, value, owner);
      return value.scalar_text(spec.name);
    case ParameterType::choice:
      break;
  }
  if (!value.is_scalar()) refuse(spec, value, owner);
  const std::string text = value.scalar_text(spec.name);
  for (const std::string& choice : spec.choices) {
    if (is_same_name(choice, text)) return choice;
  }
  refuse(spec, value, owner);
}

/// A setting of the command line arrives as text; its type decides how it is read.
Node as_document_value(const ParameterSpec& spec, const Node& value) {
  const bool is_plain_text = spec.type == ParameterType::choice || spec.type == ParameterType::text;
  if (is_plain_text || value.kind() != Node::Kind::text) return value;
  return Node::from_plain_scalar(value.scalar_text(spec.name), value.place());
}

}  // namespace

ParameterSpec integer_parameter(std::string name, std::int64_t value, const Bounds& bounds,
                                std::string unit, std::string doc) {
  return {std::move(name), ParameterType::integer, value, bounds.min, bounds.max, {},
          std::move(unit), std::move(doc)};
}

ParameterSpec real_parameter(std::string name, double value, const Bounds& bounds, std::string unit,
                             std::string doc) {
  return {std::move(name), ParameterType::real, value, bounds.min, bounds.max, {},
          std::move(unit), std::move(doc)};
}

ParameterSpec boolean_parameter(std::string name, bool value, std::string doc) {
  return {std::move(name), ParameterType::boolean, value, {}, {}, {}, {}, std::move(doc)};
}

ParameterSpec choice_parameter(std::string name, std::vector<std::string> choices,
                               std::string value, std::string doc) {
  return {std::move(name), ParameterType::choice, std::move(value), {}, {}, std::move(choices), {},
          std::move(doc)};
}

Parameters::Parameters(std::vector<std::pair<std::string, ParameterValue>> values)
    : values_(std::move(values)) {}

const ParameterValue& Parameters::value(std::string_view name) const {
  for (const auto& [key, value] : values_) {
    if (is_same_name(key, name)) return value;
  }
  throw InputError(fmt::format("parameter \"{}\" is not declared", name));
}

bool Parameters::boolean(std::string_view name) const { return std::get<bool>(value(name)); }

std::int64_t Parameters::integer(std::string_view name) const {
  return std::get<std::int64_t>(value(name));
}

double Parameters::real(std::string_view name) const { return std::get<double>(value(name)); }

const std::string& Parameters::text(std::string_view name) const {
  return std::get<std::string>(value(name));
}

bool Parameters::contains(std::string_view name) const {
  return std::any_of(values_.begin(), values_.end(),
                     [&](const auto& entry) { return is_same_name(entry.first, name); });
}

void Parameters::set(std::string_view name, ParameterValue new_value) {
  for (auto& [key, value] : values_) {
    if (!is_same_name(key, name)) continue;
    assert(value.index() == new_value.index());
    value = std::move(new_value);
    return;
  }
  throw InputError(fmt::format("parameter \"{}\" is not declared", name));
}

nlohmann::ordered_json Parameters::to_json() const {
  auto json = nlohmann::ordered_json::object();
  for (const auto& [key, value] : values_) json[key] = base::to_json(value);
  return json;
}

std::string Parameters::to_text() const {
  std::string text;
  for (const auto& [key, value] : values_) {
    const std::string* word = std::get_if<std::string>(&value);
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", key,
                        word != nullptr ? *word : base::to_json(value).dump());
  }
  return text;
}

ParameterSetting parse_setting(std::string_view text, const std::string& origin) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw InputError(
        fmt::format("{}: \"{}\" is not a setting; accepted: name=value", origin, text));
  }
  return {snake_case(text.substr(0, equals)),
          Node::from_text(std::string(text.substr(equals + 1)), Place{origin, 0, 0})};
}

Parameters resolve_parameters(std::span<const ParameterSpec> specs, const Preset* preset,
                              std::span<const ParameterSetting> settings,
                              const std::string& owner) {
  std::vector<std::pair<std::string, ParameterValue>> values;
  std::vector<std::string> names;
  for (const ParameterSpec& spec : specs) {
    values.emplace_back(spec.name, spec.default_value);
    names.push_back(spec.name);
  }
  Parameters parameters(std::move(values));
  if (preset != nullptr) {
    for (const auto& [name, value] : preset->values) parameters.set(name, value);
  }
  std::vector<std::string_view> seen;
  for (const ParameterSetting& setting : settings) {
    const auto spec = std::find_if(specs.begin(), specs.end(), [&](const ParameterSpec& candidate) {
      return is_same_name(candidate.name, setting.name);
    });
    if (spec == specs.end()) {
      throw InputError(setting.value.place(),
                       unknown_name("parameter", setting.name, names) + " of " + owner);
    }
    if (std::find(seen.begin(), seen.end(), spec->name) != seen.end()) {
      throw InputError(setting.value.place(), fmt::format("parameter \"{}\" of {} is given twice; "
                                                          "accepted: once",
                                                          spec->name, owner));
    }
    seen.push_back(spec->name);
    parameters.set(spec->name, read_value(*spec, as_document_value(*spec, setting.value), owner));
  }
  return parameters;
}

nlohmann::ordered_json to_json(const ParameterValue& value) {
  return std::visit([](const auto& held) { return nlohmann::ordered_json(held); }, value);
}

nlohmann::ordered_json to_json(const ParameterSpec& spec) {
  nlohmann::ordered_json json;
  json["name"] = spec.name;
  json["type"] = to_string(spec.type);
  json["default"] = to_json(spec.default_value);
  json["min"] = spec.min ? nlohmann::ordered_json(*spec.min) : nlohmann::ordered_json();
  json["max"] = spec.max ? nlohmann::ordered_json(*spec.max) : nlohmann::ordered_json();
  json["choices"] = spec.choices;
  json["unit"] = spec.unit;
  json["doc"] = spec.doc;
  return json;
}

}  // namespace base

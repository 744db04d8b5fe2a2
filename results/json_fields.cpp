#include "results/json_fields.h"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "results/run_record.h"

namespace results {

using nlohmann::ordered_json;

namespace {

std::string excerpt(const ordered_json& json) {
  constexpr std::size_t kLongest = 60;
  std::string text = to_line(json);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

}  // namespace

JsonFields::JsonFields(const ordered_json& json, std::string what)
    : json_(json), what_(std::move(what)) {
  if (!json.is_object()) {
    throw base::InputError(
        fmt::format("{}: expected a JSON object, found {}", what_, excerpt(json)));
  }
  const ordered_json* schema = find("schema");
  if (schema == nullptr) return;
  if (!schema->is_number_integer()) fail("schema", "a whole number", *schema);
  if (schema->get<std::int64_t>() > kSchemaVersion) {
    throw base::InputError(
        fmt::format("{}: schema {} is newer than this program reads; accepted: 1 to {}", what_,
                    schema->get<std::int64_t>(), kSchemaVersion));
  }
}

const ordered_json* JsonFields::find(const char* key) const {
  const auto found = json_.find(key);
  return found == json_.end() ? nullptr : &*found;
}

const ordered_json& JsonFields::require(const char* key) const {
  const ordered_json* value = find(key);
  if (value == nullptr) {
    throw base::InputError(fmt::format("{}: field \"{}\" is missing", what_, key));
  }
  return *value;
}

void JsonFields::fail(const std::string& field, const std::string& wanted,
                      const ordered_json& found) const {
  throw base::InputError(
      fmt::format("{}: field \"{}\" must be {}, found {}", what_, field, wanted, excerpt(found)));
}

std::string JsonFields::text(const char* key) const {
  const ordered_json& value = require(key);
  if (!value.is_string()) fail(key, "text", value);
  return value.get<std::string>();
}

std::optional<std::string> JsonFields::optional_text(const char* key) const {
  const ordered_json* value = find(key);
  if (value == nullptr || value->is_null()) return std::nullopt;
  return text(key);
}

std::int64_t JsonFields::integer(const char* key) const {
  const ordered_json& value = require(key);
  if (!value.is_number_integer()) fail(key, "a whole number", value);
  return value.get<std::int64_t>();
}

std::uint64_t JsonFields::unsigned_integer(const char* key) const {
  const ordered_json& value = require(key);
  const bool is_accepted =
      value.is_number_unsigned() || (value.is_number_integer() && value.get<std::int64_t>() >= 0);
  if (!is_accepted) fail(key, "a whole number >= 0", value);
  return value.get<std::uint64_t>();
}

std::optional<std::int64_t> JsonFields::optional_integer(const char* key) const {
  const ordered_json* value = find(key);
  if (value == nullptr || value->is_null()) return std::nullopt;
  return integer(key);
}

double JsonFields::number(const char* key) const {
  const ordered_json& value = require(key);
  if (value.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!value.is_number()) fail(key, "a number or null", value);
  return value.get<double>();
}

std::optional<double> JsonFields::optional_number(const char* key) const {
  const ordered_json* value = find(key);
  if (value == nullptr || value->is_null()) return std::nullopt;
  return number(key);
}

bool JsonFields::flag(const char* key) const {
  const ordered_json* value = find(key);
  if (value == nullptr) return false;
  if (!value->is_boolean()) fail(key, "true or false", *value);
  return value->get<bool>();
}

const ordered_json& JsonFields::list(const char* key) const {
  const ordered_json& value = require(key);
  if (!value.is_array()) fail(key, "a list", value);
  return value;
}

const ordered_json& JsonFields::object(const char* key) const {
  const ordered_json& value = require(key);
  if (!value.is_object()) fail(key, "an object", value);
  return value;
}

ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

std::string to_line(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace results

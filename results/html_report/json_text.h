#pragma once

#include <initializer_list>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace results::html_report {

/// The value under nested keys as a person reads it: text as it is, numbers shortest, lists with
/// commas; "" if a key is absent or the value null.
std::string text_at(const nlohmann::ordered_json& json, std::initializer_list<const char*> keys);

/// One value as text; objects as "key value, key value".
std::string text_of(const nlohmann::ordered_json& json);

}  // namespace results::html_report

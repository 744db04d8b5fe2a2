#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "perception/base/document.h"

namespace base {

enum class ParameterType { integer, real, boolean, choice, text };

using ParameterValue = std::variant<bool, std::int64_t, double, std::string>;

/// One declared parameter of a renderer or metric.
struct ParameterSpec {
  std::string name;  ///< snake_case
  ParameterType type = ParameterType::real;
  ParameterValue default_value;
  std::optional<double> min;         ///< inclusive; numbers only
  std::optional<double> max;         ///< inclusive; numbers only
  std::vector<std::string> choices;  ///< `choice` only, snake_case
  std::string unit;                  ///< "" if it has none
  std::string doc;                   ///< one sentence; says the source of the default, or "ours"
};

/// Least and greatest value accepted, inclusive.
struct Bounds {
  std::optional<double> min{};
  std::optional<double> max{};
};

ParameterSpec integer_parameter(std::string name, std::int64_t value, const Bounds& bounds,
                                std::string unit, std::string doc);
ParameterSpec real_parameter(std::string name, double value, const Bounds& bounds, std::string unit,
                             std::string doc);
ParameterSpec boolean_parameter(std::string name, bool value, std::string doc);
ParameterSpec choice_parameter(std::string name, std::vector<std::string> choices,
                               std::string value, std::string doc);

/// Resolved values of every declared parameter, in declaration order.
class Parameters {
 public:
  Parameters() = default;
  explicit Parameters(std::vector<std::pair<std::string, ParameterValue>> values);

  bool boolean(std::string_view name) const;
  std::int64_t integer(std::string_view name) const;
  double real(std::string_view name) const;
  const std::string& text(std::string_view name) const;  ///< of a choice or a text parameter

  const std::vector<std::pair<std::string, ParameterValue>>& entries() const { return values_; }
  bool contains(std::string_view name) const;
  /// Replaces the value of a parameter that exists; the type must stay the same.
  void set(std::string_view name, ParameterValue value);
  /// {"max_depth": 8, ...} in declaration order.
  nlohmann::ordered_json to_json() const;
  /// "max_depth=8,part=all": stable text for hashes and labels.
  std::string to_text() const;

 private:
  const ParameterValue& value(std::string_view name) const;
  std::vector<std::pair<std::string, ParameterValue>> values_;
};

/// Named values of a preset; names it does not hold keep their default.
struct Preset {
  std::string name;  ///< "paper", "best", ...
  std::vector<std::pair<std::string, ParameterValue>> values;
};

/// One value set by the user; the node carries the place for messages.
struct ParameterSetting {
  std::string name;
  Node value;
};

/// "name=value" of a command line; the value is read as a document scalar.
/// @throws InputError if there is no `=`
ParameterSetting parse_setting(std::string_view text, const std::string& origin);

/// Default values, then the preset's, then the settings', checked against type, range and choices.
///
/// @param owner  e.g. `renderer "path"`, for messages
/// @throws InputError with the place for an unknown name or a value outside what is accepted
Parameters resolve_parameters(std::span<const ParameterSpec> specs, const Preset* preset,
                              std::span<const ParameterSetting> settings, const std::string& owner);

/// {"name","type","default","min","max","choices","unit","doc"} of DESIGN section 7.
nlohmann::ordered_json to_json(const ParameterSpec& spec);
nlohmann::ordered_json to_json(const ParameterValue& value);

}  // namespace base

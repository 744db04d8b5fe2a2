#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace results {

/// Reads the fields of one JSON object of ours; every error names the record and the field.
class JsonFields {
 public:
  /// @param json  must outlive the reader
  /// @param what  names the record in messages, e.g. "cell record"
  /// @throws base::InputError if it is not an object, or of a newer schema
  JsonFields(const nlohmann::ordered_json& json, std::string what);

  /// All @throws base::InputError if the field is missing or of another type.
  const nlohmann::ordered_json& require(const char* key) const;
  std::string text(const char* key) const;
  std::optional<std::string> optional_text(const char* key) const;  ///< null or absent: nothing
  std::int64_t integer(const char* key) const;
  std::uint64_t unsigned_integer(const char* key) const;
  std::optional<std::int64_t> optional_integer(const char* key) const;
  double number(const char* key) const;  ///< null: NaN
  std::optional<double> optional_number(const char* key) const;
  bool flag(const char* key) const;  ///< absent: false
  const nlohmann::ordered_json& list(const char* key) const;
  const nlohmann::ordered_json& object(const char* key) const;

  [[noreturn]] void fail(const std::string& field, const std::string& wanted,
                         const nlohmann::ordered_json& found) const;
  const std::string& what() const { return what_; }

 private:
  const nlohmann::ordered_json* find(const char* key) const;
  const nlohmann::ordered_json& json_;
  std::string what_;
};

/// A finite number, else null.
nlohmann::ordered_json finite_or_null(double value);

/// One line without a newline; bytes that are not UTF-8 (of logs) become U+FFFD.
std::string to_line(const nlohmann::ordered_json& json);

}  // namespace results

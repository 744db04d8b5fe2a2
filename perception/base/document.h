#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "perception/base/errors.h"

namespace base {

/// One value of a strict YAML or JSON document; every value knows where it stands in the file.
///
/// Strict: duplicate keys, `yes/no/on/off` for booleans, leading-zero numbers, anchors with tags
/// and several documents in one file are refused with their position.
class Node {
 public:
  enum class Kind { null, boolean, integer, real, text, list, map };

  Node() = default;
  /// A text value that did not come from a file, e.g. from the command line.
  static Node from_text(std::string text, Place place);
  /// Reads a plain scalar as a document would: `3` is an integer, `3.5` real, `true` a boolean.
  static Node from_plain_scalar(std::string_view text, const Place& place);
  static Node make_map(Place place);
  static Node make_list(Place place);

  Kind kind() const { return kind_; }
  const Place& place() const { return place_; }
  void set_place(Place place) { place_ = std::move(place); }
  /// Where the first character of a text stands: behind its quote, if it has one. (Of a text under
  /// `|` or `>` it is that of the sign.)
  Place text_place() const;
  bool is_null() const { return kind_ == Kind::null; }
  bool is_map() const { return kind_ == Kind::map; }
  bool is_list() const { return kind_ == Kind::list; }
  bool is_number() const { return kind_ == Kind::integer || kind_ == Kind::real; }
  bool is_scalar() const { return !is_map() && !is_list() && !is_null(); }

  /// The value as the type asked for.
  /// @param what  names the value in the message, e.g. "vertical_fov_deg"
  /// @throws InputError with the place if the kind differs
  bool boolean(std::string_view what) const;
  std::int64_t integer(std::string_view what) const;
  double number(std::string_view what) const;  ///< integers are numbers; NaN and inf are refused
  const std::string& text(std::string_view what) const;
  const std::vector<Node>& list(std::string_view what) const;

  /// The scalar as it stands in the file ("10s", "2", "true"); for values with units and names.
  std::string scalar_text(std::string_view what) const;

  /// Entries of a map in file order; empty for every other kind.
  const std::vector<std::pair<std::string, Node>>& entries() const { return entries_; }
  /// The place of a map's key, for messages about the key itself.
  Place key_place(std::string_view key) const;
  /// The value of a key, or null if the map lacks it. Keys match up to `-` and `_`.
  const Node* find(std::string_view key) const;
  /// Adds or replaces (in place) the value of a key.
  void set(const std::string& key, Node value, Place key_place);
  void append(Node value) { list_.push_back(std::move(value)); }

  /// Readable name of a kind: "a list", "a whole number", ...
  static std::string kind_name(Kind kind);

  nlohmann::ordered_json to_json() const;

 private:
  friend class DocumentReader;
  [[noreturn]] void fail_kind(std::string_view what, std::string_view wanted) const;

  Kind kind_ = Kind::null;
  Place place_;
  bool is_quoted_ = false;
  bool boolean_ = false;
  std::int64_t integer_ = 0;
  double real_ = 0;
  std::string text_;
  std::vector<Node> list_;
  std::vector<std::pair<std::string, Node>> entries_;
  std::vector<Place> key_places_;
};

/// Parses YAML (JSON is valid input).
/// @param file_name  used in positions only
/// @throws InputError with file:line:column
Node parse_document(std::string_view text, const std::string& file_name);

/// Reads and parses a file. @throws InputError if it cannot be read or parsed
Node read_document(const std::filesystem::path& path);

/// Reads a map key by key and refuses what nobody asked for.
///
///     MapReader reader(node, "camera");
///     camera.fov = reader.number("vertical_fov_deg", 40.0);
///     reader.finish();   // throws for keys that were not read, with the nearest known one
class MapReader {
 public:
  /// @throws InputError if the node is not a map
  MapReader(const Node& node, std::string what);

  const Node* find(std::string_view key);
  const Node& require(std::string_view key);  ///< @throws InputError naming the missing key

  bool boolean(std::string_view key, bool fallback);
  std::int64_t integer(std::string_view key, std::int64_t fallback);
  double number(std::string_view key, double fallback);
  std::string text(std::string_view key, const std::string& fallback);
  std::string required_text(std::string_view key);

  /// @throws InputError for the first key that was never asked for, listing the accepted ones
  void finish() const;

  const Node& node() const { return node_; }
  const std::string& what() const { return what_; }

 private:
  const Node& node_;
  std::string what_;
  std::vector<std::string> asked_;  ///< in the order asked, without repeats
};

/// The numbers of a list of fixed length, e.g. a position.
/// @throws InputError if the node is not a list of exactly `count` numbers
std::vector<double> number_list(const Node& node, std::string_view what, std::size_t count);

}  // namespace base

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/document.h"
#include "perception/base/names.h"

namespace base {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// True if the text has the shape of a decimal number: sign, digits, fraction, exponent.
bool has_number_shape(std::string_view text) {
  std::size_t i = 0;
  if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
  std::size_t digits = 0;
  for (; i < text.size() && is_digit(text[i]); ++i) ++digits;
  if (i < text.size() && text[i] == '.') {
    for (++i; i < text.size() && is_digit(text[i]); ++i) ++digits;
  }
  if (digits == 0) return false;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
    const std::size_t exponent_begin = i;
    while (i < text.size() && is_digit(text[i])) ++i;
    if (i == exponent_begin) return false;
  }
  return i == text.size();
}

/// True for 010, -007, 00.5: octal to some readers, decimal to others.
bool has_leading_zero(std::string_view text) {
  if (text.front() == '-' || text.front() == '+') text.remove_prefix(1);
  return text.size() > 1 && text[0] == '0' && is_digit(text[1]);
}

/// Words that YAML 1.1 readers take for booleans or numbers and others for text.
bool is_ambiguous_word(std::string_view text) {
  static constexpr std::array kWords{"yes",  "no",    "on",    "off", ".nan",
                                     ".inf", "-.inf", "+.inf", "nan", "inf"};
  const std::string lower = kebab_case(text);
  if (std::find(kWords.begin(), kWords.end(), lower) != kWords.end()) return true;
  return (lower == "true" || lower == "false" || lower == "null") && text != lower;
}

std::string_view without_plus(std::string_view text) {
  return text.front() == '+' ? text.substr(1) : text;
}

}  // namespace

Place Node::text_place() const {
  Place place = place_;
  if (is_quoted_ && place.line > 0) ++place.column;
  return place;
}

Node Node::from_text(std::string text, Place place) {
  Node node;
  node.kind_ = Kind::text;
  node.text_ = std::move(text);
  node.place_ = std::move(place);
  return node;
}

Node Node::from_plain_scalar(std::string_view text, const Place& place) {
  Node node = from_text(std::string(text), place);
  if (text.empty() || text == "~" || text == "null") {
    node.kind_ = Kind::null;
  } else if (text == "true" || text == "false") {
    node.kind_ = Kind::boolean;
    node.boolean_ = text == "true";
  } else if (is_ambiguous_word(text)) {
    throw InputError(place, fmt::format("\"{}\" is not accepted: write true or false, a finite "
                                        "number, or quote it if text is meant",
                                        text));
  } else if (has_number_shape(text)) {
    if (has_leading_zero(text)) {
      throw InputError(place, fmt::format("number \"{}\" has a leading zero; write it without, or "
                                          "quote it if text is meant",
                                          text));
    }
    const std::string_view digits = without_plus(text);
    const char* end = digits.data() + digits.size();
    const auto integer = std::from_chars(digits.data(), end, node.integer_);
    if (integer.ec == std::errc{} && integer.ptr == end) {
      node.kind_ = Kind::integer;
      node.real_ = static_cast<double>(node.integer_);
    } else {
      const auto real = std::from_chars(digits.data(), end, node.real_);
      if (real.ec != std::errc{}) {
        throw InputError(place, fmt::format("number \"{}\" is out of range", text));
      }
      node.kind_ = Kind::real;
    }
  }
  return node;
}

Node Node::make_map(Place place) {
  Node node;
  node.kind_ = Kind::map;
  node.place_ = std::move(place);
  return node;
}

Node Node::make_list(Place place) {
  Node node;
  node.kind_ = Kind::list;
  node.place_ = std::move(place);
  return node;
}

std::string Node::kind_name(Kind kind) {
  switch (kind) {
    case Kind::null:
      return "nothing";
    case Kind::boolean:
      return "true or false";
    case Kind::integer:
      return "a whole number";
    case Kind::real:
      return "a number";
    case Kind::text:
      return "text";
    case Kind::list:
      return "a list";
    case Kind::map:
      return "a map";
  }
  return "nothing";
}

void Node::fail_kind(std::string_view what, std::string_view wanted) const {
  const std::string found =
      is_scalar() ? fmt::format("\"{}\" ({})", text_, kind_name(kind_)) : kind_name(kind_);
  throw InputError(place_, fmt::format("{} must be {}, not {}", what, wanted, found));
}

bool Node::boolean(std::string_view what) const {
  if (kind_ != Kind::boolean) fail_kind(what, "true or false");
  return boolean_;
}

std::int64_t Node::integer(std::string_view what) const {
  if (kind_ != Kind::integer) fail_kind(what, "a whole number");
  return integer_;
}

double Node::number(std::string_view what) const {
  if (!is_number()) fail_kind(what, "a number");
  return real_;
}

const std::string& Node::text(std::string_view what) const {
  if (kind_ != Kind::text) fail_kind(what, "text");
  return text_;
}

const std::vector<Node>& Node::list(std::string_view what) const {
  if (kind_ != Kind::list) fail_kind(what, "a list");
  return list_;
}

std::string Node::scalar_text(std::string_view what) const {
  if (!is_scalar()) fail_kind(what, "a single value");
  return text_;
}

Place Node::key_place(std::string_view key) const {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (is_same_name(entries_[i].first, key)) return key_places_[i];
  }
  return place_;
}

const Node* Node::find(std::string_view key) const {
  for (const auto& [name, value] : entries_) {
    if (is_same_name(name, key)) return &value;
  }
  return nullptr;
}

void Node::set(const std::string& key, Node value, Place key_place) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (!is_same_name(entries_[i].first, key)) continue;
    entries_[i].second = std::move(value);
    key_places_[i] = std::move(key_place);
    return;
  }
  entries_.emplace_back(key, std::move(value));
  key_places_.push_back(std::move(key_place));
}

nlohmann::ordered_json Node::to_json() const {
  switch (kind_) {
    case Kind::null:
      return nullptr;
    case Kind::boolean:
      return boolean_;
    case Kind::integer:
      return integer_;
    case Kind::real:
      return real_;
    case Kind::text:
      return text_;
    case Kind::list: {
      auto json = nlohmann::ordered_json::array();
      for (const Node& item : list_) json.push_back(item.to_json());
      return json;
    }
    case Kind::map:
      break;
  }
  auto json = nlohmann::ordered_json::object();
  for (const auto& [key, value] : entries_) json[key] = value.to_json();
  return json;
}

}  // namespace base

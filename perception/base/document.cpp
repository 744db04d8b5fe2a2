#include "perception/base/document.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include "perception/base/atomic_file.h"

namespace base {

/// Builds nodes from yaml-cpp's events; its own node tree would lose duplicate keys and quoting.
class DocumentReader : public YAML::EventHandler {
 public:
  explicit DocumentReader(std::string file_name) : file_name_(std::move(file_name)) {}

  Node take_root() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    Node node;
    node.place_ = place_of(mark);
    add(std::move(node));
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { refuse_anchor(mark, 1); }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_anchor(mark, anchor);
    const Place place = place_of(mark);
    if (expects_key()) {
      begin_entry(value, place);
    } else if (tag == "?") {
      add(Node::from_plain_scalar(value, place));
    } else if (tag == "!" || tag.empty()) {
      Node text = Node::from_text(value, place);
      text.is_quoted_ = true;
      add(std::move(text));
    } else {
      throw InputError(place, fmt::format("tag \"{}\" is not accepted; write plain values", tag));
    }
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, anchor, Node::make_list(place_of(mark)));
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, anchor, Node::make_map(place_of(mark)));
  }
  void OnMapEnd() override { close(); }

 private:
  struct OpenNode {
    Node node;
    std::string key;
    Place key_place;
    bool has_key = false;
  };

  Place place_of(const YAML::Mark& mark) const {
    return {file_name_, mark.line + 1, mark.column + 1};
  }

  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) const {
    if (anchor == 0) return;
    throw InputError(place_of(mark), "anchors and aliases are not accepted; write the value out");
  }

  bool expects_key() const {
    return !open_.empty() && open_.back().node.is_map() && !open_.back().has_key;
  }

  void begin_entry(const std::string& key, const Place& place) {
    OpenNode& parent = open_.back();
    if (parent.node.find(key) != nullptr) {
      const Place first = parent.node.key_place(key);
      throw InputError(
          place, fmt::format("duplicate key \"{}\"; it stands first in line {}", key, first.line));
    }
    parent.key = key;
    parent.key_place = place;
    parent.has_key = true;
  }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor, Node node) {
    refuse_anchor(mark, anchor);
    if (expects_key()) throw InputError(place_of(mark), "a key must be a plain word");
    open_.push_back({std::move(node), {}, {}, false});
  }

  void close() {
    Node node = std::move(open_.back().node);
    open_.pop_back();
    add(std::move(node));
  }

  void add(Node node) {
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    OpenNode& parent = open_.back();
    if (parent.node.is_list()) {
      parent.node.append(std::move(node));
    } else {
      if (!parent.has_key) throw InputError(node.place(), "a key must be a plain word");
      parent.node.set(parent.key, std::move(node), parent.key_place);
      parent.has_key = false;
    }
  }

  std::string file_name_;
  Node root_;
  std::vector<OpenNode> open_;
};

Node parse_document(std::string_view text, const std::string& file_name) {
  std::istringstream stream{std::string(text)};
  DocumentReader reader(file_name);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(reader);
    Node root = reader.take_root();
    if (root.place().file.empty()) root.set_place({file_name, 1, 1});
    DocumentReader rest(file_name);
    if (parser.HandleNextDocument(rest)) {
      throw InputError(Place{file_name, 0, 0}, "holds several documents; one is accepted");
    }
    return root;
  } catch (const YAML::Exception& error) {
    throw InputError(Place{file_name, error.mark.line + 1, error.mark.column + 1},
                     "not valid YAML or JSON: " + error.msg);
  }
}

Node read_document(const std::filesystem::path& path) {
  return parse_document(read_text_file(path), path.string());
}

MapReader::MapReader(const Node& node, std::string what) : node_(node), what_(std::move(what)) {
  if (!node.is_map()) {
    throw InputError(node.place(), fmt::format("{} must be a map of keys and values, not {}", what_,
                                               Node::kind_name(node.kind())));
  }
}

const Node* MapReader::find(std::string_view key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.emplace_back(key);
  return node_.find(key);
}

const Node& MapReader::require(std::string_view key) {
  const Node* node = find(key);
  if (node != nullptr) return *node;
  throw InputError(node_.place(), fmt::format("{} has no \"{}\"; it is required", what_, key));
}

bool MapReader::boolean(std::string_view key, bool fallback) {
  const Node* node = find(key);
  return node != nullptr ? node->boolean(key) : fallback;
}

std::int64_t MapReader::integer(std::string_view key, std::int64_t fallback) {
  const Node* node = find(key);
  return node != nullptr ? node->integer(key) : fallback;
}

double MapReader::number(std::string_view key, double fallback) {
  const Node* node = find(key);
  return node != nullptr ? node->number(key) : fallback;
}

std::string MapReader::text(std::string_view key, const std::string& fallback) {
  const Node* node = find(key);
  return node != nullptr ? node->text(key) : fallback;
}

std::string MapReader::required_text(std::string_view key) { return require(key).text(key); }

void MapReader::finish() const {
  for (const auto& [key, value] : node_.entries()) {
    const bool is_known = std::any_of(asked_.begin(), asked_.end(), [&](const std::string& known) {
      const Node* node = node_.find(known);
      return node == &value;
    });
    if (is_known) continue;
    throw InputError(node_.key_place(key), unknown_name("key", key, asked_) + " in " + what_);
  }
}

std::vector<double> number_list(const Node& node, std::string_view what, std::size_t count) {
  const std::vector<Node>& items = node.list(what);
  if (items.size() != count) {
    throw InputError(node.place(),
                     fmt::format("{} must hold {} numbers, not {}", what, count, items.size()));
  }
  std::vector<double> numbers;
  for (const Node& item : items) numbers.push_back(item.number(what));
  return numbers;
}

}  // namespace base

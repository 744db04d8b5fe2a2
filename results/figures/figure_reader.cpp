#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "perception/base/names.h"
#include "results/figures/figure_spec.h"
#include "results/row_selector.h"

namespace results::figures {

namespace {

/// Which of the fields that not every kind has a kind takes.
struct KindFields {
  bool x = false;
  bool y = false;
  bool log = false;
  bool pictures = false;  ///< against
  bool needs_x = false;
  bool needs_y = false;
};

KindFields fields_of(FigureKind kind) {
  switch (kind) {
    case FigureKind::error_vs_parameter:
      return {.x = true, .y = true, .log = true, .needs_x = true, .needs_y = true};
    case FigureKind::error_vs_time:
    case FigureKind::pareto:
      return {.x = true, .y = true, .log = true, .needs_y = true};
    case FigureKind::error_chain:
    case FigureKind::series:
      return {.y = true, .log = true, .needs_y = true};
    case FigureKind::stage_stack:
      return {};
    case FigureKind::image_grid:
      return {.y = true, .pictures = true};
    case FigureKind::false_colour:
      return {.pictures = true};
  }
  return {};
}

PlacedText placed_text(const base::Node& node, const std::string& what) {
  return {node.scalar_text(what), node.place()};
}

/// One text or a list of them; a list may not be empty.
std::vector<PlacedText> texts(base::MapReader& reader, const char* key) {
  const base::Node* node = reader.find(key);
  if (node == nullptr) return {};
  if (!node->is_list()) return {placed_text(*node, key)};
  std::vector<PlacedText> result;
  for (const base::Node& item : node->list(key)) result.push_back(placed_text(item, key));
  if (result.empty()) {
    throw base::InputError(node->place(),
                           fmt::format("{} is an empty list; leave it out for all", key));
  }
  return result;
}

template <std::size_t Count>
std::size_t index_of(const base::Node& node, const std::string& kind,
                     const std::array<const char*, Count>& names) {
  const std::string text = node.text(kind);
  const std::vector<std::string> known(names.begin(), names.end());
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (base::is_same_name(known[i], text)) return i;
  }
  throw base::InputError(node.place(), base::unknown_name(kind, text, known));
}

void read_log(base::MapReader& reader, const KindFields& fields, FigureSpec& figure) {
  const base::Node* node = reader.find("log");
  if (node == nullptr) return;
  static constexpr std::array<const char*, 2> kAxes{"x", "y"};
  figure.is_log_x = figure.is_log_y = false;
  for (const base::Node& item : node->list("log")) {
    const bool is_y = index_of(item, "axis", kAxes) == 1;
    if (!is_y && !fields.x) {
      throw base::InputError(item.place(), fmt::format("the x axis of {} has no numbers of its own;"
                                                       " accepted: y",
                                                       to_string(figure.kind)));
    }
    (is_y ? figure.is_log_y : figure.is_log_x) = true;
  }
}

void read_size(base::MapReader& reader, FigureSpec& figure) {
  constexpr double kLeast_cm = 4.0;
  constexpr double kMost_cm = 100.0;
  const base::Node* node = reader.find("size_cm");
  if (node == nullptr) return;
  const std::vector<base::Node>& sides = node->list("size_cm");
  figure.has_height = sides.size() == 2;
  if (sides.empty() || sides.size() > 2) {
    throw base::InputError(node->place(), "size_cm takes [width] or [width, height]");
  }
  for (const base::Node& side : sides) {
    const double cm = side.number("size_cm");
    if (cm >= kLeast_cm && cm <= kMost_cm) continue;
    throw base::InputError(
        side.place(), fmt::format("size_cm is {}; accepted: {} ... {}", cm, kLeast_cm, kMost_cm));
  }
  figure.width_cm = sides[0].number("size_cm");
  if (figure.has_height) figure.height_cm = sides[1].number("size_cm");
}

FigureCrop read_crop(const base::Node& node) {
  base::MapReader reader(node, "crop");
  FigureCrop crop;
  const auto side = [&](const char* key) { return reader.require(key).number(key); };
  crop = {side("x"), side("y"), side("width"), side("height")};
  reader.finish();
  const bool is_inside = crop.x >= 0.0 && crop.y >= 0.0 && crop.width > 0.0 && crop.height > 0.0 &&
                         crop.x + crop.width <= 1.0 && crop.y + crop.height <= 1.0;
  if (!is_inside) {
    throw base::InputError(node.place(),
                           fmt::format("crop [{}, {}] + [{}, {}] leaves the image; accepted: "
                                       "fractions of it, 0 ... 1",
                                       crop.x, crop.y, crop.width, crop.height));
  }
  return crop;
}

void read_pictures(base::MapReader& reader, FigureSpec& figure) {
  static constexpr std::array<const char*, 2> kSides{"own", "full"};
  const bool has_maps = figure.kind == FigureKind::false_colour;
  figure.against = has_maps ? "own" : "full";
  if (const base::Node* node = reader.find("against")) {
    figure.against = kSides.at(index_of(*node, "against", kSides));
  }
  if (has_maps) {
    figure.metric = placed_text(reader.require("metric"), "metric");
    return;
  }
  const base::Node* crops = reader.find("crops");
  if (crops == nullptr) return;
  for (const base::Node& crop : crops->list("crops")) figure.crops.push_back(read_crop(crop));
}

void require_texts(const base::MapReader& reader, const FigureSpec& figure, const char* key) {
  throw base::InputError(reader.node().place(),
                         fmt::format("{} needs \"{}\"; a {} figure is "
                                     "nothing without it",
                                     reader.what(), key, to_string(figure.kind)));
}

FigureSpec read_figure(const base::Node& node) {
  base::MapReader reader(node, "figure");
  FigureSpec figure;
  figure.place = node.place();
  figure.id = reader.required_text("id");
  if (!base::is_path_safe(figure.id)) {
    throw base::InputError(reader.require("id").place(),
                           fmt::format("figure id \"{}\" is no file name; accepted: letters, "
                                       "digits, . _ -, not starting with . or -",
                                       figure.id));
  }
  figure.kind =
      static_cast<FigureKind>(index_of(reader.require("kind"), "kind of figure", kFigureKindNames));
  figure.title = reader.text("title", "");
  figure.methods = texts(reader, "methods");
  for (const PlacedText& method : figure.methods) parse_row_selector(method.text, method.place);
  figure.scenes = texts(reader, "scenes");
  figure.budgets = texts(reader, "budgets");
  const KindFields fields = fields_of(figure.kind);
  if (fields.x) {
    if (const base::Node* x = reader.find("x")) figure.x = placed_text(*x, "x");
  }
  if (fields.y) figure.y = texts(reader, "y");
  if (fields.log) read_log(reader, fields, figure);
  if (fields.pictures) read_pictures(reader, figure);
  read_size(reader, figure);
  reader.finish();
  if (fields.needs_x && figure.x.text.empty()) require_texts(reader, figure, "x");
  if (fields.needs_y && figure.y.empty()) require_texts(reader, figure, "y");
  const bool is_chain = figure.kind == FigureKind::error_chain;
  if (is_chain && figure.methods.size() < 2) require_texts(reader, figure, "methods: [from, to]");
  return figure;
}

}  // namespace

std::vector<FigureSpec> read_figures(const base::Node& list) {
  std::vector<FigureSpec> figures;
  std::set<std::string> ids;
  for (const base::Node& node : list.list("figures")) {
    figures.push_back(read_figure(node));
    const std::string& id = figures.back().id;
    if (ids.insert(id).second) continue;
    throw base::InputError(node.find("id")->place(),
                           fmt::format("two figures have the id \"{}\"", id));
  }
  return figures;
}

}  // namespace results::figures

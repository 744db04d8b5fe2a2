#include "results/figures/figure_spec.h"

#include <nlohmann/json.hpp>

namespace results::figures {

using nlohmann::ordered_json;

namespace {

void add_texts(ordered_json& json, const char* key, const std::vector<PlacedText>& texts) {
  for (const PlacedText& text : texts) json[key].push_back(text.text);
}

void add_text(ordered_json& json, const char* key, const std::string& text) {
  if (!text.empty()) json[key] = text;
}

void add_log(ordered_json& json, const FigureSpec& figure) {
  if (!figure.is_log_x && !figure.is_log_y) return;
  json["log"] = ordered_json::array();
  if (figure.is_log_x.value_or(false)) json["log"].push_back("x");
  if (figure.is_log_y.value_or(false)) json["log"].push_back("y");
}

void add_size(ordered_json& json, const FigureSpec& figure) {
  json["size_cm"] = {figure.width_cm};
  if (figure.has_height) json["size_cm"].push_back(figure.height_cm);
}

}  // namespace

std::string to_string(FigureKind kind) {
  return kFigureKindNames.at(static_cast<std::size_t>(kind));
}

ordered_json to_json(const FigureSpec& figure) {
  ordered_json json{{"id", figure.id}, {"kind", to_string(figure.kind)}};
  add_text(json, "title", figure.title);
  add_texts(json, "methods", figure.methods);
  add_texts(json, "scenes", figure.scenes);
  add_texts(json, "budgets", figure.budgets);
  add_text(json, "x", figure.x.text);
  add_texts(json, "y", figure.y);
  add_log(json, figure);
  add_text(json, "metric", figure.metric.text);
  add_text(json, "against", figure.against);
  add_size(json, figure);
  for (const FigureCrop& crop : figure.crops) {
    json["crops"].push_back(
        {{"x", crop.x}, {"y", crop.y}, {"width", crop.width}, {"height", crop.height}});
  }
  return json;
}

std::vector<FigureSpec> figures_from_json(const ordered_json& json, const std::string& file) {
  std::vector<FigureSpec> figures = read_figures(base::parse_document(json.dump(), file));
  // A position in a line of JSON that we wrote tells nobody anything.
  const base::Place somewhere{file, 0, 0};
  for (FigureSpec& figure : figures) {
    figure.place = figure.x.place = figure.metric.place = somewhere;
    for (auto* texts : {&figure.methods, &figure.scenes, &figure.budgets, &figure.y}) {
      for (PlacedText& text : *texts) text.place = somewhere;
    }
  }
  return figures;
}

}  // namespace results::figures

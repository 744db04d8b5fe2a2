#include "suites/command_line/ad_hoc_suite.h"

#include <algorithm>
#include <sstream>

#include "perception/base/document.h"
#include "perception/base/names.h"
#include "perception/base/parameter_spec.h"
#include "perception/viewing_conditions.h"
#include "renderers/scene/scene_file.h"

namespace suites::command_line {

namespace {

const std::vector<std::string> kDefaultMetrics{"relmse", "flip", "ssim"};
constexpr const char* kDefaultSize = "256x256";

/// A document written by the options of one command line.
class DocumentBuilder {
 public:
  explicit DocumentBuilder(std::string option) : place_{std::move(option)} {}

  const base::Place& place() const { return place_; }
  base::Node map() const { return base::Node::make_map(place_); }
  base::Node list() const { return base::Node::make_list(place_); }
  base::Node text(const std::string& value) const { return base::Node::from_text(value, place_); }
  base::Node scalar(const std::string& value) const {
    return base::Node::from_plain_scalar(value, place_);
  }
  base::Node number(double value) const { return scalar(fmt_number(value)); }
  base::Node list_of(const std::vector<std::string>& values) const {
    base::Node node = list();
    for (const std::string& value : values) node.append(text(value));
    return node;
  }
  void set(base::Node& map, const std::string& key, base::Node value) const {
    map.set(key, std::move(value), place_);
  }

 private:
  static std::string fmt_number(double value) {
    std::ostringstream text;
    text.precision(17);
    text << value;
    return text.str();
  }
  base::Place place_;
};

/// A file name made of a method as written: "path,samples=8" -> "path-samples-8".
std::string method_id(const std::string& text) {
  std::string id = text;
  for (char& c : id) {
    if (!base::is_path_safe(std::string("x") + c)) c = '-';
  }
  return id;
}

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
  if (words.empty()) words.emplace_back();
  return words;
}

base::Node budget_node(const DocumentBuilder& builder, const std::string& key, base::Node value) {
  base::Node budget = builder.map();
  builder.set(budget, key, std::move(value));
  return budget;
}

/// `renderer[,preset=P][,parameter=value]...`; `samples=N` becomes the method's own budget.
base::Node method_node(const std::string& text) {
  const DocumentBuilder builder("--method " + text);
  const std::vector<std::string> words = split_at_commas(text);
  base::Node method = builder.map();
  builder.set(method, "id", builder.text(method_id(text)));
  builder.set(method, "renderer", builder.text(words.front()));
  base::Node parameters = builder.map();
  for (std::size_t i = 1; i < words.size(); ++i) {
    const base::ParameterSetting setting = base::parse_setting(words[i], builder.place().file);
    const std::string value = setting.value.scalar_text(setting.name);
    if (setting.name == "preset") {
      builder.set(method, "preset", builder.text(value));
    } else if (setting.name == "samples") {
      base::Node budgets = builder.list();
      budgets.append(budget_node(builder, "samples", builder.scalar(value)));
      builder.set(method, "budgets", std::move(budgets));
    } else {
      builder.set(parameters, setting.name, builder.scalar(value));
    }
  }
  builder.set(method, "parameters", std::move(parameters));
  return method;
}

base::Node scene_node(const std::string& text, const SuiteSelection& selection) {
  const DocumentBuilder builder("--scene");
  const DocumentBuilder size_builder("--size");
  const std::filesystem::path file = find_scene_option(text);
  const base::SizePx size = base::parse_size_px(
      selection.size.empty() ? kDefaultSize : selection.size, size_builder.place());
  base::Node scene = builder.map();
  builder.set(scene, "id", builder.text(file.stem().string()));
  builder.set(scene, "file", builder.text(file.string()));
  base::Node sides = size_builder.list();
  sides.append(size_builder.scalar(std::to_string(size.width)));
  sides.append(size_builder.scalar(std::to_string(size.height)));
  builder.set(scene, "size", std::move(sides));
  if (selection.reference_samples) {
    base::Node reference = builder.map();
    builder.set(reference, "samples", builder.scalar(std::to_string(*selection.reference_samples)));
    builder.set(scene, "reference", std::move(reference));
  }
  return scene;
}

base::Node budgets_node(const SuiteSelection& selection) {
  const DocumentBuilder samples("--samples");
  const DocumentBuilder times("--time");
  base::Node budgets = samples.list();
  for (const std::string& count : selection.samples) {
    budgets.append(budget_node(samples, "samples", samples.scalar(count)));
  }
  for (const std::string& time : selection.times) {
    budgets.append(budget_node(times, "time", times.text(time)));
  }
  if (budgets.list("budgets").empty()) budgets.append(samples.text("fixed"));
  return budgets;
}

/// The viewing default of one-off commands, written out as suites must (DESIGN section 3).
base::Node viewing_node() {
  const DocumentBuilder builder("viewing default");
  const perception::ViewingConditions defaults = perception::default_viewing_conditions();
  base::Node display = builder.map();
  builder.set(display, "peak_cd_m2", builder.number(defaults.peak_cd_m2));
  builder.set(display, "black_cd_m2", builder.number(defaults.black_cd_m2));
  builder.set(display, "ambient_lux", builder.number(defaults.ambient_lux));
  base::Node viewing = builder.map();
  builder.set(viewing, "ppd", builder.number(defaults.pixels_per_degree));
  builder.set(viewing, "display", std::move(display));
  builder.set(viewing, "exposure", builder.text("scene"));
  return viewing;
}

}  // namespace

std::filesystem::path find_scene_option(const std::string& path_or_name) {
  return std::filesystem::absolute(renderers::scene::find_scene_file(
      path_or_name, scene_folder(), std::filesystem::current_path(), {"--scene"}));
}

Suite make_ad_hoc_suite(const SuiteSelection& selection) {
  if (selection.scenes.empty() || selection.methods.empty()) {
    throw base::InputError(
        "nothing to run: accepted: a suite, or at least one --scene and one --method");
  }
  const DocumentBuilder builder("command line");
  base::Node document = builder.map();
  builder.set(document, "schema", builder.scalar("1"));
  builder.set(document, "suite", builder.text("ad-hoc"));
  builder.set(document, "viewing", viewing_node());
  base::Node scenes = builder.list();
  for (const std::string& scene : selection.scenes) scenes.append(scene_node(scene, selection));
  builder.set(document, "scenes", std::move(scenes));
  base::Node methods = builder.list();
  for (const std::string& method : selection.methods) methods.append(method_node(method));
  builder.set(document, "methods", std::move(methods));
  builder.set(document, "budgets", budgets_node(selection));
  const DocumentBuilder metrics("--metric");
  builder.set(document, "metrics",
              metrics.list_of(selection.metrics.empty() ? kDefaultMetrics : selection.metrics));
  return parse_suite(document, std::filesystem::current_path() / "command-line.yaml", "");
}

}  // namespace suites::command_line

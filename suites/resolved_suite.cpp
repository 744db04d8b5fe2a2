#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "suites/suite_file.h"
#include "suites/suite_methods.h"

namespace suites {
namespace {

/// Keys that only reports read; they stand at the end, each at the start of a line.
constexpr const char* kClaimsKey = "claims: ";
constexpr const char* kPaperKey = "paper: ";
constexpr const char* kFiguresKey = "figures: ";
constexpr const char* kGatesKey = "gates: ";

/// Text always quoted, so that no name is read as a number or a boolean.
std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

std::string yaml_of(const base::ParameterValue& value) { return base::to_json(value).dump(); }

std::string yaml_of(const Budget& budget) {
  if (budget.samples) return fmt::format("{{samples: {}}}", *budget.samples);
  if (budget.time_s) return fmt::format("{{time: {}s}}", *budget.time_s);
  if (!budget.time_of.empty()) return fmt::format("{{time: {{of: {}}}}}", quoted(budget.time_of));
  if (budget.error) {
    return fmt::format("{{error: {{metric: {}, at: {}}}}}", quoted(budget.error->metric),
                       budget.error->at);
  }
  return "fixed";
}

std::string yaml_of(const std::vector<Budget>& budgets) {
  std::vector<std::string> items;
  for (const Budget& budget : budgets) items.push_back(yaml_of(budget));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

/// The catalogue name where the file is the catalogue's, so that the text is the same everywhere.
std::string scene_name(const std::filesystem::path& file) {
  const std::filesystem::path path = std::filesystem::weakly_canonical(file);
  const std::filesystem::path in_catalog =
      std::filesystem::weakly_canonical(scene_folder()) / path.filename();
  return path == in_catalog && path.extension() == ".yaml" ? path.stem().string() : path.string();
}

std::string yaml_of(const FrameRange& frames) {
  if (!frames.is_sequence) return fmt::format("frame: {}", frames.first);
  return fmt::format("frames: {{first: {}, last: {}, step: {}}}", frames.first, frames.last,
                     frames.step);
}

/// "renderer: ..., samples: ...", with the picture that stands in for it.
std::string yaml_of(const ReferenceSpec& spec) {
  std::string text = fmt::format("renderer: {}, samples: {}, seed: {}", quoted(spec.renderer),
                                 spec.samples, spec.seed);
  if (!spec.own) return text;
  std::vector<std::string> values;
  for (const auto& [name, value] : spec.own->choice.parameters.entries()) {
    if (name != "part") values.push_back(fmt::format("{}: {}", name, yaml_of(value)));
  }
  return text + fmt::format(
                    ", own: {{renderer: {}, preset: {}, seed: {},\n"
                    "     parameters: {{{}}}}}",
                    quoted(spec.own->choice.info->name), quoted(spec.own->choice.preset),
                    spec.own->seed, fmt::join(values, ", "));
}

/// `set` and the sweep values, those as axes of one value.
std::string settings_yaml(const SuiteScene& scene) {
  std::string text;
  if (scene.set) text += fmt::format(",\n     set: {}", scene.set->to_json().dump());
  std::vector<std::string> axes;
  for (std::size_t i = 0; i < scene.sweep.size(); ++i) {
    const auto& [name, value] = scene.sweep[i];
    const SceneSetting& setting = scene.sweep_settings[i];
    axes.push_back(setting.path.empty()
                       ? fmt::format("{}: {{{}: {}}}", quoted(name), yaml_of(value),
                                     setting.overlay.to_json().dump())
                       : fmt::format("{}: {{path: {}, values: [{}]}}", quoted(name),
                                     quoted(setting.path), yaml_of(value)));
  }
  if (!axes.empty()) text += fmt::format(",\n     matrix: {{{}}}", fmt::join(axes, ", "));
  return text;
}

std::string measure_yaml(const MeasureChange& change) {
  return change.is_empty() ? std::string() : fmt::format(",\n     measure: {}", to_yaml(change));
}

/// Every scene of a grid by itself.
std::string yaml_of(const SuiteScene& scene) {
  return fmt::format(
      "  - {{id: {}, file: {}, size: [{}, {}], {},\n"
      "     reference: {{{}}}{}{}}}\n",
      quoted(scene.base_id), quoted(scene_name(scene.file)), scene.size_px.width,
      scene.size_px.height, yaml_of(scene.frames), yaml_of(scene.reference), settings_yaml(scene),
      measure_yaml(scene.measure));
}

bool is_swept(const SuiteMethod& method, const std::string& name) {
  return std::any_of(method.sweep.begin(), method.sweep.end(),
                     [&](const auto& entry) { return entry.first == name; });
}

/// Every method of a grid by itself, its sweep values as a matrix of one point.
std::string yaml_of(const SuiteMethod& method, const std::vector<Budget>& suite_budgets) {
  const bool has_samples = !are_samples_budgeted(method, suite_budgets);
  std::vector<std::string> parameters;
  std::vector<std::string> matrix;
  for (const auto& [name, value] : method.choice.parameters.entries()) {
    if (is_swept(method, name)) continue;
    if (name == "samples" && method.choice.info->progressive_unit && !has_samples) continue;
    if (method.search && method.search->name == name) continue;
    parameters.push_back(fmt::format("{}: {}", name, yaml_of(value)));
  }
  for (const auto& [name, value] : method.sweep) {
    matrix.push_back(fmt::format("{}: [{}]", name, yaml_of(value)));
  }
  std::string text = fmt::format("  - {{id: {}, renderer: {}, preset: {},\n     parameters: {{{}}}",
                                 quoted(method.base_id), quoted(method.choice.info->name),
                                 quoted(method.choice.preset), fmt::join(parameters, ", "));
  if (!matrix.empty()) text += fmt::format(",\n     matrix: {{{}}}", fmt::join(matrix, ", "));
  if (method.search) {
    text += fmt::format(",\n     search: {{setting: {}, from: {}, to: {}}}", method.search->name,
                        method.search->from, method.search->to);
  }
  if (!method.scenes.empty()) {
    std::vector<std::string> scenes;
    for (const std::string& id : method.scenes) scenes.push_back(quoted(id));
    text += fmt::format(",\n     scenes: [{}]", fmt::join(scenes, ", "));
  }
  if (!method.budgets.empty()) text += fmt::format(",\n     budgets: {}", yaml_of(method.budgets));
  return text + measure_yaml(method.measure) + "}\n";
}

std::string yaml_of(const MeasurePlan& plan) {
  return fmt::format(
      "measure:\n  seeds: {}\n  repetitions: {{min: {}, max: {}, until: {:.12g}%}}\n  warmup: {}\n"
      "  order: {}\n  new_view: {}\n  convergence: {}\n  timeout: {}s\n  memory: {}B\n",
      plan.seeds, plan.min_repetitions, plan.max_repetitions, 100.0 * plan.until_relative_spread,
      plan.warmup, plan.is_interleaved ? "interleaved" : "blocks", plan.has_new_view,
      plan.has_convergence, plan.timeout_s, plan.memory_bytes);
}

std::string viewing_yaml(const Suite& suite) {
  const perception::ViewingConditions& viewing = suite.viewing;
  std::string text = fmt::format(
      "viewing:\n  ppd: {}\n  display: {{transfer: {}, peak_cd_m2: {}, black_cd_m2: {}, "
      "ambient_lux: {}}}\n  exposure: {}\n",
      viewing.pixels_per_degree, to_string(viewing.transfer), viewing.peak_cd_m2,
      viewing.black_cd_m2, viewing.ambient_lux,
      suite.exposure_from_scene ? "scene" : fmt::format("{}", viewing.exposure_ev));
  if (viewing.luminance_scale_origin == "suite") {
    text += fmt::format("  luminance_scale_cd_m2: {}\n", viewing.luminance_scale_cd_m2);
  }
  return text;
}

}  // namespace

std::string resolved_yaml(const Suite& suite) {
  std::string text = fmt::format("schema: 1\nsuite: {}\n", quoted(suite.name));
  if (!suite.summary.empty()) text += fmt::format("summary: {}\n", quoted(suite.summary));
  if (!suite.profile.empty()) text += fmt::format("profile: {}\n", quoted(suite.profile));
  text += viewing_yaml(suite);
  text += "scenes:\n";
  for (const SuiteScene& scene : suite.scenes) text += yaml_of(scene);
  text += "methods:\n";
  for (const SuiteMethod& method : suite.methods) text += yaml_of(method, suite.budgets);
  text += fmt::format("budgets: {}\n", yaml_of(suite.budgets));
  text += yaml_of(suite.measure);
  std::vector<std::string> metrics;
  for (const SuiteMetric& metric : suite.metrics) metrics.push_back(to_yaml(metric));
  text += fmt::format("metrics: [{}]\n", fmt::join(metrics, ", "));
  // JSON on one line is YAML, too; what follows is left out by measured_part.
  if (!suite.claims.empty()) {
    text += fmt::format("{}{}\n", kClaimsKey, results::claims::to_json(suite.claims).dump());
  }
  if (suite.paper) {
    text += fmt::format("{}{}\n", kPaperKey, results::claims::to_json(*suite.paper).dump());
  }
  if (!suite.figures.empty()) {
    nlohmann::ordered_json figures = nlohmann::ordered_json::array();
    for (const auto& figure : suite.figures) figures.push_back(results::figures::to_json(figure));
    text += fmt::format("{}{}\n", kFiguresKey, figures.dump());
  }
  if (!suite.gates.empty()) {
    text += fmt::format("{}{}\n", kGatesKey, results::gates::to_json(suite.gates).dump());
  }
  return text;
}

std::string measured_part(const std::string& resolved) {
  std::size_t end = resolved.size();
  for (const std::string key : {kClaimsKey, kPaperKey, kFiguresKey, kGatesKey}) {
    const std::size_t found = resolved.find("\n" + key);
    if (found != std::string::npos) end = std::min(end, found + 1);
  }
  return resolved.substr(0, end);
}

}  // namespace suites

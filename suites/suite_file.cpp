#include "suites/suite_file.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "perception/base/names.h"
#include "renderers/scene/scene_file.h"
#include "suites/reference_spec.h"
#include "suites/safe_name.h"
#include "suites/scene_sweep.h"
#include "suites/suite_methods.h"
#include "suites/suite_profiles.h"

namespace suites {
namespace {

std::int64_t bounded(const base::Node& node, const char* what, std::int64_t low,
                     std::int64_t high) {
  const std::int64_t value = node.integer(what);
  if (value < low || value > high) {
    throw base::InputError(node.place(),
                           fmt::format("{} is {}; accepted: {} to {}", what, value, low, high));
  }
  return value;
}

base::SizePx read_size(const base::Node& node) {
  if (node.is_list()) {
    const auto& sides = node.list("size");
    if (sides.size() == 2) {
      return {static_cast<int>(bounded(sides[0], "width", 1, 65536)),
              static_cast<int>(bounded(sides[1], "height", 1, 65536))};
    }
  }
  throw base::InputError(node.place(), "size must be [width, height] in pixels, e.g. [400, 300]");
}

/// A scene's entry as the scenes that it stands for.
std::vector<SuiteScene> read_scene(const base::Node& node, const std::filesystem::path& folder) {
  base::MapReader reader(node, "scene");
  SuiteScene scene;
  scene.id = scene.base_id = read_safe_name(reader.require("id"), "id");
  const base::Node& file = reader.require("file");
  scene.file =
      renderers::scene::find_scene_file(file.text("file"), scene_folder(), folder, file.place());
  if (const base::Node* size = reader.find("size")) scene.size_px = read_size(*size);
  scene.frames = read_frame_range(reader);
  if (const base::Node* spec = reader.find("reference")) scene.reference = read_reference(*spec);
  if (const base::Node* measure = reader.find("measure")) {
    scene.measure = read_measure_change(*measure);
  }
  if (const base::Node* set = reader.find("set")) scene.set = base::MapReader(*set, "set").node();
  const GridKeys keys{reader.find("matrix"), reader.find("zip"), reader.find("include"),
                      reader.find("exclude")};
  reader.finish();
  return swept_scenes(scene, keys);
}

std::vector<SuiteScene> read_scenes(const base::Node& node, const std::filesystem::path& folder) {
  std::vector<SuiteScene> scenes;
  std::set<std::string> ids;
  for (const base::Node& item : node.list("scenes")) {
    for (SuiteScene& scene : read_scene(item, folder)) {
      if (!ids.insert(scene.id).second) {
        throw base::InputError(item.find("id")->place(),
                               fmt::format("scene id \"{}\" is used twice", scene.id));
      }
      scenes.push_back(std::move(scene));
    }
  }
  if (scenes.empty()) throw base::InputError(node.place(), "scenes is empty");
  return scenes;
}

void check_head(base::MapReader& reader) {
  const base::Node& schema = reader.require("schema");
  if (schema.integer("schema") != 1) {
    throw base::InputError(schema.place(),
                           fmt::format("schema is {}; accepted: 1", schema.scalar_text("schema")));
  }
  if (const base::Node* kind = reader.find("kind");
      kind != nullptr && kind->text("kind") != "images") {
    const bool is_other_kind = kind->text("kind") == "psychophysics";
    throw base::InputError(
        kind->place(),
        fmt::format("kind is \"{}\"; accepted{}: images{}", kind->text("kind"),
                    is_other_kind ? " here" : "", is_other_kind ? "" : ", psychophysics"));
  }
}

/// Budgets by error and equal time name metrics and methods of the same suite.
void check_targets(const Suite& suite, const base::Node& node, const base::Node* budgets) {
  std::vector<std::string> texts;
  for (const SuiteMetric& metric : suite.metrics) {
    // A search scores whole pictures.
    if (metric.id.empty()) texts.push_back(text_of(metric));
  }
  if (budgets != nullptr) {
    check_budget_targets(suite.methods, suite.budgets, texts, budgets->place());
  }
  for (const SuiteMethod& method : suite.methods) {
    check_budget_targets(suite.methods, method.budgets, texts, node.key_place("methods"));
    check_method_scenes(method, suite.scenes, node.key_place("methods"));
  }
}

void read_metrics_of(Suite& suite, const base::Node& list) {
  suite.metrics = read_metrics(list, suite.file.parent_path());
  for (std::size_t i = 0; i < suite.metrics.size(); ++i) {
    const base::Place& place = list.list("metrics")[i].place();
    require_frames(suite.metrics[i].choice, suite.scenes, place);
    check_metric_places(suite.metrics[i], suite.scenes, suite.methods, place);
  }
}

/// A gate on a score that is not made would never close. @throws base::InputError at its name
void require_known_metric(const Suite& suite, const results::gates::Gate& gate) {
  const std::string score = gate.quantity.substr(0, gate.quantity.find('@'));
  std::vector<std::string> known;
  for (const SuiteMetric& metric : suite.metrics) {
    const std::string& text = text_of(metric);
    const bool is_detail = score.size() > text.size() && score[text.size()] == '.';
    if (base::is_same_name(score, text) ||
        (is_detail && base::is_same_name(score.substr(0, text.size()), text))) {
      return;
    }
    known.push_back(text);
  }
  throw base::InputError(
      gate.place,
      fmt::format("gate: {}", base::unknown_name("metric of this suite", score, known)));
}

/// A gate on rows that do not exist would never close.
std::vector<results::gates::Gate> read_gates_of(const Suite& suite, const base::Node& list) {
  std::vector<results::gates::Gate> gates = results::gates::read_gates(list);
  const auto require_known = [](const auto& entries, const char* kind,
                                const std::vector<std::string>& ids, const base::Place& place) {
    std::vector<std::string> known;
    for (const auto& entry : entries) {
      for (const std::string& id : {entry.base_id, entry.id}) {
        if (std::find(known.begin(), known.end(), id) == known.end()) known.push_back(id);
      }
    }
    for (const std::string& id : ids) {
      if (std::find(known.begin(), known.end(), id) != known.end()) continue;
      throw base::InputError(place, fmt::format("gate: {}", base::unknown_name(kind, id, known)));
    }
  };
  for (const results::gates::Gate& gate : gates) {
    require_known(suite.scenes, "scene", gate.scenes, gate.place);
    require_known(suite.methods, "method", gate.methods, gate.place);
    if (gate.is_score) require_known_metric(suite, gate);
  }
  return gates;
}

/// One document without profiles, or with one of them merged.
Suite read_merged(const base::Node& node, const std::filesystem::path& file) {
  base::MapReader reader(node, "suite");
  Suite suite;
  suite.file = file;
  check_head(reader);
  suite.name = read_safe_name(reader.require("suite"), "suite");
  suite.summary = reader.text("summary", "");
  reader.find("profiles");
  suite.profile = reader.text("profile", "");
  const base::Node& viewing = reader.require("viewing");
  suite.viewing = perception::read_viewing_conditions(viewing);
  suite.exposure_from_scene = perception::takes_exposure_from_scene(suite.viewing);
  suite.scenes = read_scenes(reader.require("scenes"), file.parent_path());
  const base::Node* budgets = reader.find("budgets");
  suite.budgets = budgets == nullptr ? std::vector<Budget>{Budget{}} : read_budgets(*budgets);
  suite.methods = read_methods(reader.require("methods"), suite.budgets);
  if (const base::Node* measure = reader.find("measure")) suite.measure = read_measure(*measure);
  if (const base::Node* list = reader.find("metrics")) read_metrics_of(suite, *list);
  check_targets(suite, node, budgets);
  if (const base::Node* claims = reader.find("claims")) {
    suite.claims = results::claims::read_claims(*claims);
  }
  if (const base::Node* paper = reader.find("paper")) {
    suite.paper = results::claims::read_ledger(*paper);
    results::claims::check_ledger(*suite.paper, suite.claims);
  }
  if (const base::Node* figures = reader.find("figures")) {
    suite.figures = results::figures::read_figures(*figures);
  }
  if (const base::Node* gates = reader.find("gates")) suite.gates = read_gates_of(suite, *gates);
  reader.finish();
  return suite;
}

}  // namespace

std::size_t frames_needed(const metrics::AnyMetricChoice& choice) {
  const auto* of_sequence = std::get_if<metrics::SequenceMetricChoice>(&choice);
  if (of_sequence == nullptr) return 1;
  const auto metric = of_sequence->info->create(of_sequence->parameters);
  return static_cast<std::size_t>(metric->history_frames()) + 1;
}

void require_frames(const metrics::AnyMetricChoice& choice, const std::vector<SuiteScene>& scenes,
                    const base::Place& place) {
  const std::size_t needed = frames_needed(choice);
  const auto is_long_enough = [&](const SuiteScene& scene) {
    return scene.frames.numbers().size() >= needed;
  };
  if (std::any_of(scenes.begin(), scenes.end(), is_long_enough)) return;
  throw base::InputError(
      place, fmt::format("metric \"{}\" scores sequences, and no scene here has {} frames; "
                         "accepted: a scene with `frames: [first, last]`, or image metrics only",
                         description_of(choice).name, needed));
}

namespace {

/// A claim for a profile that the suite lacks would never be judged.
void check_claimed_profiles(const Suite& suite, const std::vector<std::string>& profiles) {
  for (const results::claims::Claim& claim : suite.claims) {
    for (const std::string& name : claim.profiles) {
      if (std::find(profiles.begin(), profiles.end(), name) != profiles.end()) continue;
      throw base::InputError(
          claim.place,
          fmt::format("claim \"{}\": {}", claim.id, base::unknown_name("profile", name, profiles)));
    }
  }
}

}  // namespace

Suite parse_suite(const base::Node& node, const std::filesystem::path& file,
                  const std::string& profile) {
  if (node.find("profiles") != nullptr && node.find("profile") != nullptr) {
    throw base::InputError(node.key_place("profile"),
                           "profile names what a resolved suite was made with; it cannot stand "
                           "beside profiles");
  }
  // Every profile is read, whichever is asked for: a slip in one shows at once.
  Suite suite = read_merged(node, file);
  for (const std::string& name : profile_names(node)) {
    Suite merged = read_merged(with_profile(node, name), file);
    if (name != profile) continue;
    suite = std::move(merged);
    suite.profile = name;
  }
  if (!profile.empty() && suite.profile != profile) with_profile(node, profile);
  // A resolved suite holds the profile that it was made with only.
  if (node.find("profile") == nullptr) check_claimed_profiles(suite, profile_names(node));
  return suite;
}

Suite read_suite(const std::filesystem::path& path, const std::string& profile) {
  return parse_suite(base::read_document(path), path, profile);
}

}  // namespace suites

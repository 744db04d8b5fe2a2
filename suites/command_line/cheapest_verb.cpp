#include <algorithm>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/units.h"
#include "results/cheapest.h"
#include "results/result_store.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/option_values.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

namespace {

/// "0.05" or "5%".
double parse_limit(const std::string& text) {
  const bool is_percentage = !text.empty() && text.back() == '%';
  return is_percentage ? base::parse_percent(text, base::Place{"--below"})
                       : parse_number_option(text, "--below");
}

}  // namespace

int run_cheapest(const CheapestArguments& arguments, Console& console) {
  const double limit = parse_limit(arguments.below);
  const std::filesystem::path root = results::results_root(arguments.results);
  const results::Run run = results::load_run(results::find_run(root, arguments.run));
  const std::vector<results::CheapestOfScene> scenes = results::cheapest_settings(
      results::RunValues(run), arguments.metric, arguments.against, limit);
  const std::string score = fmt::format("{} ({})", arguments.metric, arguments.against);
  if (arguments.json) {
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", "ok"},
                         {"run", run.folder.string()},
                         {"metric", arguments.metric},
                         {"against", arguments.against},
                         {"below", limit},
                         {"scenes", results::to_json(scenes)}});
  } else {
    console.out << results::to_text(results::cheapest_table(scenes, score, limit));
  }
  const bool has_any = std::ranges::any_of(scenes, [](const results::CheapestOfScene& scene) {
    return std::ranges::any_of(scene.candidates, [](const results::Candidate& candidate) {
      return candidate.visibility != results::Visibility::unknown;
    });
  });
  return has_any ? kAsExpected : kNothingMeasured;
}

}  // namespace suites::command_line

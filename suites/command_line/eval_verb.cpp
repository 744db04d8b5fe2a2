#include <algorithm>
#include <ostream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/document.h"
#include "perception/base/names.h"
#include "results/result_store.h"
#include "results/run_record.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/interrupt.h"
#include "suites/command_line/progress_display.h"
#include "suites/command_line/run_outcome.h"
#include "suites/command_line/verbs.h"
#include "suites/suite_runner.h"

namespace suites::command_line {

namespace {

/// The suite that a run was made from, with other metrics if any are asked for.
Suite suite_of(const results::Run& run, const std::vector<std::string>& metric_texts) {
  const std::filesystem::path file = run.folder / "suite.resolved.yaml";
  if (run.resolved_suite.empty()) {
    throw base::InputError({file.string()}, "missing or empty; the run cannot be scored again");
  }
  Suite suite = parse_suite(base::parse_document(run.resolved_suite, file.string()), file, "");
  if (metric_texts.empty()) return suite;
  const std::vector<SuiteMetric> own = std::exchange(suite.metrics, {});
  for (const std::string& text : metric_texts) {
    const auto found = std::find_if(own.begin(), own.end(), [&](const SuiteMetric& one) {
      return !one.id.empty() && base::is_same_name(one.id, text);
    });
    suite.metrics.push_back(
        found != own.end() ? *found
                           : SuiteMetric(metrics::parse_any_metric_choice(text, {"--metric"})));
    require_frames(suite.metrics.back().choice, suite.scenes, {"--metric"});
  }
  return suite;
}

}  // namespace

int run_eval(const EvalArguments& arguments, Console& console) {
  RunOptions options;
  options.results_root = results::results_root(arguments.results);
  options.filter = arguments.filter;
  options.threads = arguments.threads;
  const std::filesystem::path folder = results::find_run(options.results_root, arguments.run);
  const Suite suite = suite_of(results::load_run(folder), arguments.metrics);
  handle_interrupts(OnInterrupt::stop_soon);
  std::size_t scores = 0;
  {
    ProgressDisplay display(console);
    scores =
        evaluate_run(suite, folder, options, [&display](const Progress& p) { display.show(p); });
  }
  const std::filesystem::path report = write_run_report(results::load_run(folder), console).index;
  if (arguments.json) {
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", "ok"},
                         {"run", folder.string()},
                         {"scores", scores},
                         {"report", report.string()}});
  } else {
    console.out << fmt::format("{} scores\nreport  {}\n", scores, report.string());
  }
  return kAsExpected;
}

}  // namespace suites::command_line

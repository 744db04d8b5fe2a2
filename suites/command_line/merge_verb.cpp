#include <algorithm>
#include <ostream>

#include <nlohmann/json.hpp>

#include "results/result_store.h"
#include "results/run_record.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/run_outcome.h"
#include "suites/command_line/verbs.h"
#include "suites/run_merge.h"

namespace suites::command_line {

int run_merge(const MergeArguments& arguments, Console& console) {
  const std::filesystem::path root = results::results_root(arguments.results);
  std::vector<std::filesystem::path> parts;
  for (const std::string& run : arguments.runs) parts.push_back(results::find_run(root, run));
  const std::filesystem::path folder = merge_runs(root, parts);
  const results::Run run = results::load_run(folder);
  const std::string report = write_run_report(run, console).index.string();
  if (arguments.json) {
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", "ok"},
                         {"run", folder.string()},
                         {"report", report},
                         {"parts", parts.size()},
                         {"repetitions", run.cells.size()}});
  } else {
    console.out << "run     " << folder.string() << "\nreport  " << report << '\n';
  }
  const bool has_failure = std::ranges::any_of(run.cells, [](const results::CellRecord& record) {
    return results::is_failure(record.render.status);
  });
  return has_failure ? kCellsFailed : kAsExpected;
}

}  // namespace suites::command_line

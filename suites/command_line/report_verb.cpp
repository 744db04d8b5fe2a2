#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/units.h"
#include "results/html_report/html_report.h"
#include "results/result_store.h"
#include "results/run_record.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/psychophysics_verbs.h"
#include "suites/command_line/run_outcome.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

using results::html_report::Split;

int run_report(const ReportArguments& arguments, Console& console) {
  if (arguments.split && arguments.one_file) {
    throw base::InputError("--split with --one-file; accepted: one of them, or neither");
  }
  const std::filesystem::path root = results::results_root(arguments.results);
  const std::filesystem::path folder = results::find_run(root, arguments.run);
  if (results::run_kind(folder) == "psychophysics") {
    return report_psychophysics(folder, arguments.json, console);
  }
  const results::Run run = results::load_run(folder);
  results::html_report::ReportOptions options;
  if (arguments.split) options.split = Split::always;
  if (arguments.one_file) options.split = Split::never;
  const results::html_report::ReportFiles report = write_run_report(run, console, options);
  return print_report(
      {run.folder.string(), report.index.string(), run.cells.size(), run.metrics.size(),
       run.unreadable_lines, report.is_split, report.data_bytes},
      arguments.json, console);
}

results::html_report::ReportFiles write_run_report(
    const results::Run& run, Console& console, const results::html_report::ReportOptions& options) {
  const results::html_report::ReportFiles files = results::html_report::write_report(run, options);
  if (files.is_split) {
    print_note(console, fmt::format("{} of images are in {}, beside the report: keep them together",
                                    base::format_bytes(static_cast<double>(files.data_bytes)),
                                    (files.index.parent_path() / "data").string()));
  }
  return files;
}

int print_report(const WrittenReport& written, bool as_json, Console& console) {
  if (as_json) {
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", "ok"},
                         {"run", written.run},
                         {"report", written.report},
                         {"repetitions", written.repetitions},
                         {"scores", written.scores},
                         {"unreadable_lines", written.unreadable_lines},
                         {"split", written.is_split},
                         {"data_bytes", written.data_bytes}});
    return kAsExpected;
  }
  if (written.unreadable_lines > 0) {
    print_note(console,
               std::to_string(written.unreadable_lines) + " unreadable lines were left out");
  }
  console.out << written.report << '\n';
  return kAsExpected;
}

}  // namespace suites::command_line

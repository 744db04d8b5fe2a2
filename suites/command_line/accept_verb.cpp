#include <cstdlib>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/gates/baseline.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/verbs.h"
#include "suites/name_filter.h"

namespace suites::command_line {

namespace {

std::string user_name() {
  for (const char* variable : {"USER", "LOGNAME"}) {
    const char* name = std::getenv(variable);
    if (name != nullptr && *name != '\0') return name;
  }
  return "unknown";
}

nlohmann::ordered_json rows_json(const results::gates::AcceptOutcome& outcome) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const results::gates::AcceptedRow& row : outcome.rows) {
    rows.push_back({{"scene", row.scene},
                    {"method", row.method},
                    {"budget", row.budget},
                    {"old_hash", row.old_hash.empty() ? nlohmann::ordered_json(nullptr)
                                                      : nlohmann::ordered_json(row.old_hash)},
                    {"new_hash", row.new_hash}});
  }
  return rows;
}

std::size_t count_changed(const results::gates::AcceptOutcome& outcome) {
  std::size_t changed = 0;
  for (const auto& row : outcome.rows) {
    if (!row.old_hash.empty() && row.old_hash != row.new_hash) ++changed;
  }
  return changed;
}

}  // namespace

int run_accept(const AcceptArguments& arguments, Console& console) {
  if (arguments.reason.find_first_not_of(' ') == std::string::npos) {
    throw base::InputError("--reason is empty; accepted: why later runs shall be compared with it");
  }
  const std::filesystem::path root = results::results_root(arguments.results);
  const results::Run run = results::load_run(results::find_run(root, arguments.run));
  results::gates::Acceptance acceptance;
  acceptance.author = arguments.author.empty() ? user_name() : arguments.author;
  acceptance.reason = arguments.reason;
  if (!arguments.filter.empty()) {
    acceptance.is_chosen = [filter =
                                NameFilter(arguments.filter)](const results::CellRecord& record) {
      return filter.matches(record.scene) || filter.matches(record.method) ||
             filter.matches(record.cell);
    };
  }
  const results::gates::AcceptOutcome outcome = results::gates::accept(root, run, acceptance);
  for (const std::string& row : outcome.left_out) {
    print_note(console, "not accepted, as it has no result: " + row);
  }
  if (arguments.json) {
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", "ok"},
                         {"run", run.folder.string()},
                         {"baseline", outcome.file.string()},
                         {"author", acceptance.author},
                         {"reason", acceptance.reason},
                         {"rows", rows_json(outcome)},
                         {"left_out", outcome.left_out}});
  } else {
    console.out << fmt::format("accepted {} rows of {} ({} with other pixels than before)\n{}\n",
                               outcome.rows.size(), run.folder.filename().string(),
                               count_changed(outcome), outcome.file.string());
  }
  return kAsExpected;
}

}  // namespace suites::command_line

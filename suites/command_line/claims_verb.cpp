#include <algorithm>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/claims/claim_result.h"
#include "results/claims/claim_tables.h"
#include "results/table_formats.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/stored_suite.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

namespace {

using results::claims::ClaimResult;
using results::claims::Verdict;

bool has(const std::vector<ClaimResult>& all, Verdict verdict) {
  return std::any_of(all.begin(), all.end(),
                     [verdict](const ClaimResult& one) { return one.verdict == verdict; });
}

int strict_code(const std::vector<ClaimResult>& all) {
  return most_important({has(all, Verdict::not_reproduced) ? kGateFailed : kAsExpected,
                         has(all, Verdict::inconclusive) ? kInconclusive : kAsExpected});
}

}  // namespace

int run_claims(const ClaimsArguments& arguments, Console& console) {
  const StoredSuite stored = load_stored_suite(arguments.suite, arguments.run, arguments.results);
  if (stored.suite.claims.empty()) {
    throw base::InputError({stored.suite.file.string()},
                           fmt::format("suite \"{}\" makes no claims", stored.suite.name));
  }
  const std::vector<ClaimResult> all =
      results::claims::evaluate(stored.suite.claims, results::RunValues(stored.run));
  if (arguments.json) {
    nlohmann::ordered_json json{{"schema", results::kSchemaVersion},
                                {"status", "ok"},
                                {"suite", stored.suite.name},
                                {"run", stored.run.folder.string()},
                                {"profile", stored.run.info->value("profile", "")}};
    json.update(results::claims::to_json(all));
    print_json(console, json);
  } else {
    console.out << results::to_format(results::claims::claim_table(all), arguments.format);
    if (arguments.format == "text") {
      console.out << "\nrun     " << stored.run.folder.string() << '\n';
    }
  }
  return arguments.strict ? strict_code(all) : kAsExpected;
}

}  // namespace suites::command_line

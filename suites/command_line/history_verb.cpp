#include <algorithm>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/names.h"
#include "results/history/history_output.h"
#include "results/html_report/trend_page.h"
#include "results/result_store.h"
#include "results/run_environment.h"
#include "results/run_record.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/known_words.h"
#include "suites/command_line/verbs.h"
#include "suites/name_filter.h"

namespace suites::command_line {

namespace {

using results::history::HistoryIndex;
using results::history::Query;
using results::history::Series;
using results::history::Trend;

constexpr double kLeastEffect = 0.05;  // as compare's
constexpr const char* kFirstQuantity = "total_s";

Query query_of(const HistoryArguments& arguments, const HistoryIndex& index) {
  require_known(arguments.suite, index.suites(), "history", "suite");
  Query query;
  query.suite = arguments.suite;
  query.quantity = arguments.quantity.empty() ? kFirstQuantity : arguments.quantity;
  require_known(query.quantity, index.quantities(arguments.suite), "--quantity", "quantity");
  query.machine = arguments.machine.empty() ? results::machine_name() : arguments.machine;
  require_known(query.machine, index.machines(arguments.suite), "--machine", "machine");
  const std::vector<std::string> profiles = index.profiles(arguments.suite, query.machine);
  query.profile = arguments.profile.empty() ? profiles.front() : arguments.profile;
  require_known(query.profile, profiles, "--profile", "profile");
  query.last = static_cast<std::size_t>(arguments.last.value_or(0));
  return query;
}

std::vector<Trend> trends_of(const HistoryIndex& index, const Query& query,
                             const std::string& filter) {
  const NameFilter names(filter);
  std::vector<Series> chosen = index.series(query);
  std::erase_if(chosen, [&](const Series& series) {
    return !names.matches(series.scene) && !names.matches(series.method) &&
           !names.matches(series.budget);
  });
  return results::history::trends_of(std::move(chosen), kLeastEffect);
}

/// Every quantity of the suite's rows, times first, unless one is asked for.
void write_page(const HistoryArguments& arguments, const HistoryIndex& index, Query query) {
  std::vector<std::string> names{query.quantity};
  if (arguments.quantity.empty()) {
    for (std::string& name : index.quantities(query.suite)) {
      if (name != kFirstQuantity) names.push_back(std::move(name));
    }
  }
  std::vector<results::html_report::QuantityTrends> quantities;
  for (const std::string& name : names) {
    query.quantity = name;
    std::vector<Trend> trends = trends_of(index, query, arguments.filter);
    if (!trends.empty()) quantities.push_back({name, std::move(trends)});
  }
  base::write_text_file(
      arguments.html,
      results::html_report::trend_page({query.suite, query.profile, query.machine}, quantities));
}

}  // namespace

int run_history(const HistoryArguments& arguments, Console& console) {
  HistoryIndex index(results::results_root(arguments.results));
  const HistoryIndex::Update update = index.update(arguments.rebuild);
  for (const std::string& run : update.unreadable) print_note(console, "left out: " + run);
  const Query query = query_of(arguments, index);
  const std::vector<Trend> trends = trends_of(index, query, arguments.filter);
  if (!arguments.html.empty()) write_page(arguments, index, query);
  if (arguments.json) {
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", "ok"},
                         {"suite", query.suite},
                         {"quantity", query.quantity},
                         {"profile", query.profile},
                         {"machine", query.machine},
                         {"page", arguments.html},
                         {"runs_read", update.read},
                         {"series", results::history::to_json(trends)}});
  } else {
    console.out << fmt::format("{} of {}{} on {}\n", query.quantity, query.suite,
                               query.profile.empty() ? "" : ", profile " + query.profile,
                               query.machine)
                << results::to_text(results::history::trend_table(trends));
    if (!arguments.html.empty()) console.out << arguments.html << '\n';
  }
  return trends.empty() ? kNothingMeasured : kAsExpected;
}

}  // namespace suites::command_line

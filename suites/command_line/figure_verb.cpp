#include <algorithm>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/figures/figures.h"
#include "results/run_files.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/stored_suite.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

namespace {

using results::figures::FigureFormat;
using results::figures::FigureOutcome;
using results::figures::FigureSpec;

std::vector<FigureFormat> formats_of(const std::vector<std::string>& names) {
  static const std::vector<std::pair<std::string, FigureFormat>> kKnown{
      {"pdf", FigureFormat::pdf}, {"svg", FigureFormat::svg}, {"png", FigureFormat::png}};
  std::vector<FigureFormat> formats;
  for (const std::string& name : names) {
    const auto found =
        std::ranges::find(kKnown, name, &std::pair<std::string, FigureFormat>::first);
    if (found == kKnown.end()) {
      std::vector<std::string> known;
      for (const auto& [text, format] : kKnown) known.push_back(text);
      throw base::InputError({"--format"}, base::unknown_name("format", name, known));
    }
    formats.push_back(found->second);
  }
  if (formats.empty()) {
    formats.assign(results::figures::kVectorFormats.begin(),
                   results::figures::kVectorFormats.end());
  }
  return formats;
}

std::vector<FigureSpec> figures_of(const Suite& suite, const std::string& id) {
  if (suite.figures.empty()) {
    throw base::InputError({suite.file.string()},
                           fmt::format("suite \"{}\" has no figures", suite.name));
  }
  if (id.empty()) return suite.figures;
  std::vector<std::string> ids;
  for (const FigureSpec& figure : suite.figures) {
    if (figure.id == id) return {figure};
    ids.push_back(figure.id);
  }
  throw base::InputError({suite.file.string()}, base::unknown_name("figure", id, ids));
}

nlohmann::ordered_json to_json(const FigureOutcome& outcome) {
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const auto& file : outcome.files) files.push_back(file.string());
  return {{"id", outcome.id},
          {"files", std::move(files)},
          {"notes", outcome.notes},
          {"error", outcome.error.empty() ? nlohmann::ordered_json(nullptr)
                                          : nlohmann::ordered_json(outcome.error)}};
}

void print_text(const std::vector<FigureOutcome>& outcomes, Console& console) {
  for (const FigureOutcome& outcome : outcomes) {
    for (const auto& file : outcome.files) console.out << file.string() << '\n';
    for (const std::string& note : outcome.notes) print_note(console, outcome.id + ": " + note);
    if (!outcome.error.empty()) print_error(console, outcome.error);
  }
}

}  // namespace

int run_figure(const FigureArguments& arguments, Console& console) {
  const std::vector<FigureFormat> formats = formats_of(arguments.formats);
  const StoredSuite stored = load_stored_suite(arguments.suite, arguments.run, arguments.results);
  const std::vector<FigureSpec> figures = figures_of(stored.suite, arguments.id);
  const std::filesystem::path folder =
      arguments.out.empty() ? stored.run.folder / "figures" : std::filesystem::path(arguments.out);
  if (arguments.out.empty()) results::require_no_links(stored.run.folder);
  const std::vector<FigureOutcome> outcomes =
      results::figures::write_figures(figures, results::RunValues(stored.run), folder, formats);
  const bool is_complete = std::all_of(outcomes.begin(), outcomes.end(),
                                       [](const auto& outcome) { return outcome.error.empty(); });
  if (arguments.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const FigureOutcome& outcome : outcomes) list.push_back(to_json(outcome));
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", is_complete ? "ok" : "failed"},
                         {"suite", stored.suite.name},
                         {"run", stored.run.folder.string()},
                         {"figures", std::move(list)}});
  } else {
    print_text(outcomes, console);
  }
  return is_complete ? kAsExpected : kInputError;
}

}  // namespace suites::command_line

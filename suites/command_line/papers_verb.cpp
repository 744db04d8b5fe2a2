#include <algorithm>
#include <filesystem>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/hash.h"
#include "results/claims/claim_result.h"
#include "results/figures/figures.h"
#include "results/html_report/papers_page.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/option_values.h"
#include "suites/command_line/stored_suite.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

namespace {

namespace fs = std::filesystem;
using results::html_report::Paper;
using results::html_report::PaperFigure;
using Json = nlohmann::ordered_json;

/// Suites of the catalogue that say which paper they are of.
std::vector<std::string> suites_of_papers() {
  std::vector<std::string> names;
  for (const std::string& name : catalog_suite_names()) {
    if (name.starts_with("papers/") && read_suite(find_suite(name), "").paper) {
      names.push_back(name);
    }
  }
  return names;
}

/// A message without the folder of the suite's file: pages are read elsewhere.
std::string without_folder(std::string message, const fs::path& suite_file) {
  const std::string folder = (suite_file.parent_path() / "").string();
  for (std::size_t at = message.find(folder); at != std::string::npos; at = message.find(folder)) {
    message.erase(at, folder.size());
  }
  return message;
}

/// Pictures of all figures, in a folder of the suite.
std::vector<PaperFigure> drawn_figures(const StoredSuite& stored, const fs::path& out) {
  using results::figures::FigureFormat;
  constexpr std::array kFormats{FigureFormat::png};
  const fs::path folder = out / stored.suite.name;
  std::vector<PaperFigure> figures;
  const auto outcomes = results::figures::write_figures(
      stored.suite.figures, results::RunValues(stored.run), folder, kFormats);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const bool is_made = outcomes[i].error.empty();
    figures.push_back({outcomes[i].id, stored.suite.figures[i].title,
                       is_made ? fmt::format("{}/{}.png", stored.suite.name, outcomes[i].id) : "",
                       without_folder(outcomes[i].error, stored.suite.file)});
    // The page shows pictures; what they were drawn from is in the run.
    for (const char* rest : {".csv", ".gp"}) fs::remove(folder / (outcomes[i].id + rest));
    fs::remove_all(folder / (outcomes[i].id + "-images"));
  }
  return figures;
}

class Papers {
 public:
  Papers(const PapersArguments& arguments, Console& console)
      : arguments_(arguments),
        console_(console),
        root_(results::results_root(arguments.results)),
        out_(arguments.out.empty() ? root_ / "papers" : fs::path(arguments.out)) {}

  int write() {
    const std::vector<std::string> names =
        arguments_.suites.empty() ? suites_of_papers() : arguments_.suites;
    for (const std::string& name : names) papers_.push_back(paper_of(name));
    const bool has_run =
        std::ranges::any_of(papers_, [](const Paper& paper) { return paper.info != nullptr; });
    // What is there of earlier runs is worth more than a page of none.
    if (has_run) write_files();
    print();
    return has_run ? kAsExpected : kNothingMeasured;
  }

 private:
  void write_files() {
    make_folder_of_option(out_.string(), "--out");
    add_file("index.html", results::html_report::papers_page(papers_));
    add_file("README.md", results::html_report::papers_markdown(papers_));
    for (const Paper& paper : papers_) {
      if (paper.info) add_file(paper.suite + ".md", results::html_report::paper_markdown(paper));
    }
  }

  Paper paper_of(const std::string& name) {
    const Suite suite = read_suite(find_suite(name), "");
    if (!suite.paper) {
      throw base::InputError({suite.file.string()},
                             fmt::format("suite \"{}\" is of no paper; one that is says so: "
                                         "`paper: {{source: TEXT, claims: PREFIX, rows: COUNT}}`",
                                         suite.name));
    }
    Paper paper;
    paper.suite = suite.name;
    paper.ledger = *suite.paper;
    const fs::path folder = arguments_.profile.empty() ? results::newest_run(root_, suite.name)
                                                       : results::newest_run_of_profile(
                                                             root_, suite.name, arguments_.profile);
    if (!folder.empty()) add_run(paper, load_stored_suite(name, folder.string(), root_.string()));
    paper.rows = results::claims::ledger_rows(paper.ledger, paper.results);
    return paper;
  }

  void add_run(Paper& paper, const StoredSuite& stored) const {
    paper.info = stored.run.info;
    paper.suite_hash = base::hash_of(measured_part(stored.run.resolved_suite)).hex();
    paper.results = results::claims::evaluate(stored.suite.claims, results::RunValues(stored.run));
    paper.figures = drawn_figures(stored, out_);
  }

  void add_file(const std::string& name, const std::string& text) {
    base::write_text_file(out_ / name, text);
    files_.push_back(name);
  }

  void print() const {
    if (arguments_.json) {
      Json papers = Json::array();
      for (const Paper& paper : papers_) papers.push_back(to_json(paper));
      print_json(console_, {{"schema", results::kSchemaVersion},
                            {"status", "ok"},
                            {"folder", out_.string()},
                            {"files", files_},
                            {"papers", std::move(papers)}});
      return;
    }
    for (const Paper& paper : papers_) {
      std::string counts;
      for (const auto& [state, count] : results::html_report::count_states(paper)) {
        counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ",
                              results::claims::to_words(state), count);
      }
      console_.out << fmt::format("{}: {}\n", paper.suite, counts);
      for (const PaperFigure& figure : paper.figures) {
        if (!figure.error.empty()) print_note(console_, figure.error);
      }
    }
    if (!files_.empty()) console_.out << (out_ / "index.html").string() << '\n';
  }

  static Json to_json(const Paper& paper) {
    const auto or_null = [](const std::string& text) { return text.empty() ? Json() : Json(text); };
    Json counts = Json::object();
    for (const auto& [state, count] : results::html_report::count_states(paper)) {
      counts[results::claims::to_words(state)] = count;
    }
    Json rows = Json::array();
    for (const results::claims::LedgerRow& row : paper.rows) {
      Json claims = Json::array();
      for (const auto* list : {&row.published, &row.corrected}) {
        for (const auto* result : *list) claims.push_back(result->claim.id);
      }
      rows.push_back(
          {{"id", row.id},
           {"state", results::claims::to_words(row.state)},
           {"corrected_state",
            row.corrected.empty() ? Json() : Json(results::claims::to_words(row.corrected_state))},
           {"claims", std::move(claims)}});
    }
    Json figures = Json::array();
    for (const PaperFigure& figure : paper.figures) {
      figures.push_back(
          {{"id", figure.id}, {"file", or_null(figure.file)}, {"error", or_null(figure.error)}});
    }
    return {{"suite", paper.suite},
            {"source", paper.ledger.source},
            {"run", paper.info ? Json(paper.info->value("run", "")) : Json()},
            {"profile", paper.info ? Json(paper.info->value("profile", "")) : Json()},
            {"suite_hash", or_null(paper.suite_hash)},
            {"counts", std::move(counts)},
            {"rows", std::move(rows)},
            {"figures", std::move(figures)}};
  }

  const PapersArguments& arguments_;
  Console& console_;
  fs::path root_;
  fs::path out_;
  std::vector<Paper> papers_;
  std::vector<std::string> files_;
};

}  // namespace

int run_papers(const PapersArguments& arguments, Console& console) {
  return Papers(arguments, console).write();
}

}  // namespace suites::command_line

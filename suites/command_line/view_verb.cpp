#include <map>
#include <ostream>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/image_file.h"
#include "results/result_store.h"
#include "results/run_files.h"
#include "results/run_record.h"
#include "results/run_summary.h"
#include "results/tev_viewer.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/verbs.h"
#include "suites/name_filter.h"

namespace suites::command_line {

namespace {

namespace fs = std::filesystem;

/// A stored picture, and what the viewer calls one whose pixels are sent.
struct StoredPicture {
  std::string name;
  fs::path file;
};

/// By cell: the picture of all light that its scores were made against.
std::map<std::string, fs::path> truths_of(const results::Run& run) {
  std::map<std::string, fs::path> truths;
  for (const results::MetricRecord& score : run.metrics) {
    if (score.against != "full") continue;
    truths.try_emplace(score.cell, results::reference_file(run.folder, score.reference_hash));
  }
  return truths;
}

/// A picture of every row that matches, each scene's reference before them.
std::vector<StoredPicture> pictures_of(const results::Run& run, const std::string& filter) {
  const NameFilter names(filter);
  std::vector<StoredPicture> pictures;
  const std::map<std::string, fs::path> truths = truths_of(run);
  std::set<fs::path> references;
  for (const results::SummaryRow& row : results::summarize(run).rows) {
    const bool is_wanted =
        names.matches(row.scene) || names.matches(row.method) || names.matches(row.budget);
    if (!row.shown || !is_wanted) continue;
    const results::CellRecord& record = run.cells[*row.shown];
    const auto truth = truths.find(record.cell);
    if (truth != truths.end() && fs::exists(truth->second) &&
        references.insert(truth->second).second) {
      pictures.push_back({row.scene + " reference", fs::weakly_canonical(truth->second)});
    }
    pictures.push_back({fmt::format("{} {} {}", row.scene, row.method, row.budget),
                        fs::absolute(run.folder / record.render.image)});
  }
  return pictures;
}

}  // namespace

int run_view(const ViewArguments& arguments, Console& console) {
  const results::Run run =
      results::load_run(results::find_run(results::results_root(arguments.results), arguments.run));
  const std::vector<StoredPicture> pictures = pictures_of(run, arguments.filter);
  if (pictures.empty()) {
    throw base::InputError(
        {run.folder.string()},
        fmt::format("no picture of a row that matches \"{}\"", arguments.filter));
  }
  const results::TevViewer viewer(arguments.viewer);
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const StoredPicture& picture : pictures) {
    if (arguments.sends_pixels) {
      viewer.send_image(picture.name, perception::read_image(picture.file));
    } else {
      viewer.send(results::tev_open_message(picture.file));
    }
    files.push_back(picture.file.string());
  }
  if (arguments.json) {
    print_json(console, {{"schema", results::kSchemaVersion},
                         {"status", "ok"},
                         {"run", run.folder.string()},
                         {"viewer", arguments.viewer},
                         {"pictures", files}});
  } else {
    console.out << fmt::format("{} pictures shown by {}\n", pictures.size(), arguments.viewer);
  }
  return kAsExpected;
}

}  // namespace suites::command_line

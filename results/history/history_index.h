#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "results/statistics.h"
#include "results/tables.h"

/// Numbers of all runs of a results folder, for trends.
namespace results::history {

/// What a run says of one quantity of one row.
struct Point {
  std::string run;  ///< the folder's name
  std::string utc;  ///< when the run began
  std::string commit;
  bool is_dirty = false;  ///< built from files that differ from the commit
  Estimate value;
};

/// A quantity of a row over runs, oldest first.
struct Series {
  std::string scene;
  std::string method;
  std::string budget;
  std::string device;
  std::string unit;
  Direction better = Direction::none;
  std::vector<Point> points;
};

/// Which series; runs of other machines and profiles are left out, devices are series
/// of their own: nothing is mixed.
struct Query {
  std::string suite;
  std::string quantity;  ///< "total_s", "next_frame_s", "new_view_s", a stage, "flip", "flip@full"
  std::string profile;
  std::string machine;
  std::size_t last = 0;  ///< only so many of the newest runs; 0: all
};

/// `<results>/history.sqlite`: an index of the run folders, which stay the truth. It can be thrown
/// away at any time; a file that is no database, or of another version, is made again, and in a
/// folder that cannot be written it lives in memory.
class HistoryIndex {
 public:
  /// Opens or makes the index. @throws base::InputError with the file and SQLite's reason
  explicit HistoryIndex(const std::filesystem::path& results_root);
  ~HistoryIndex();
  HistoryIndex(const HistoryIndex&) = delete;
  HistoryIndex& operator=(const HistoryIndex&) = delete;

  struct Update {
    std::size_t read = 0;                 ///< runs that were new or had grown
    std::size_t removed = 0;              ///< whose folder is gone
    std::vector<std::string> unreadable;  ///< "folder: reason"
  };
  /// Takes in run folders whose files changed since; all of them with `rebuild`.
  Update update(bool rebuild);

  std::vector<Series> series(const Query& query) const;
  std::vector<std::string> suites() const;
  /// Of the suite's runs, sorted.
  std::vector<std::string> quantities(const std::string& suite) const;
  std::vector<std::string> machines(const std::string& suite) const;
  /// Of the suite's runs on a machine, that of the newest one first.
  std::vector<std::string> profiles(const std::string& suite, const std::string& machine) const;

 private:
  struct Database;
  std::filesystem::path results_root_;
  std::unique_ptr<Database> database_;
};

}  // namespace results::history

#include "results/history/history_index.h"

#include <unistd.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "results/history/run_points.h"
#include "results/history/sqlite_statement.h"
#include "results/result_store.h"
#include "results/run_files.h"

namespace results::history {

namespace fs = std::filesystem;

namespace {

/// Of the tables below; an index of another version is made again.
constexpr std::int64_t kVersion = 1;

constexpr const char* kTables = R"(
DROP TABLE IF EXISTS points;
DROP TABLE IF EXISTS series;
DROP TABLE IF EXISTS runs;
CREATE TABLE runs (id INTEGER PRIMARY KEY, folder TEXT UNIQUE, stamp TEXT, name TEXT, suite TEXT,
                   profile TEXT, machine TEXT, utc TEXT, revision TEXT, dirty INTEGER);
CREATE TABLE series (id INTEGER PRIMARY KEY, suite TEXT, scene TEXT, method TEXT, budget TEXT,
                     device TEXT, quantity TEXT, unit TEXT, higher INTEGER,
                     UNIQUE (suite, quantity, scene, method, budget, device));
CREATE TABLE points (series INTEGER, run INTEGER, value REAL, low REAL, high REAL, count INTEGER,
                     PRIMARY KEY (series, run)) WITHOUT ROWID;
CREATE INDEX points_of_run ON points (run);
CREATE INDEX runs_of_suite ON runs (suite, profile, machine, utc);
PRAGMA user_version = 1;
)";

/// Changes whenever a file of the run does.
std::string stamp_of(const fs::path& folder) {
  std::string stamp;
  for (const char* name : {"run.json", "cells.jsonl", "metrics.jsonl"}) {
    std::error_code error;
    const auto size = fs::file_size(folder / name, error);
    if (error) continue;
    const auto time = fs::last_write_time(folder / name, error).time_since_epoch().count();
    stamp += fmt::format("{} {} {};", name, size, time);
  }
  return stamp;
}

/// "<suite>/<run>" of every run folder.
std::set<std::string> run_folders(const fs::path& runs) {
  std::set<std::string> folders;
  std::error_code error;
  for (const auto& suite : fs::directory_iterator(runs, error)) {
    for (const auto& run : fs::directory_iterator(suite.path(), error)) {
      if (fs::exists(run.path() / "run.json", error)) {
        folders.insert((suite.path().filename() / run.path().filename()).string());
      }
    }
  }
  return folders;
}

std::string text_at(const nlohmann::ordered_json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

struct HistoryIndex::Database {
  explicit Database(const fs::path& path) : file(path) {}
  SqliteFile file;

  /// Makes the tables if they are not there, or are those of another version; one process does.
  void make_current() {
    file.execute("BEGIN IMMEDIATE");
    bool is_current = false;
    {
      SqliteStatement version(file, "PRAGMA user_version");
      is_current = version.next() && version.integer(0) == kVersion;
    }
    if (!is_current) file.execute(kTables);
    file.execute("COMMIT");
  }
  void remove_run(const std::string& folder);
  void add_run(const std::string& folder, const std::string& stamp, const Run& run);
  std::int64_t series_of(const std::string& suite, const RunPoint& point);
  std::vector<std::string> texts(const char* sql, const std::string& suite);
};

void HistoryIndex::Database::remove_run(const std::string& folder) {
  SqliteStatement(file, "DELETE FROM points WHERE run IN (SELECT id FROM runs WHERE folder = ?)")
      .bind(folder)
      .run();
  SqliteStatement(file, "DELETE FROM runs WHERE folder = ?").bind(folder).run();
}

std::int64_t HistoryIndex::Database::series_of(const std::string& suite, const RunPoint& point) {
  SqliteStatement insert(file,
                         "INSERT OR IGNORE INTO series (suite, scene, method, budget, device, "
                         "quantity, unit, higher) VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(suite).bind(point.scene).bind(point.method).bind(point.budget).bind(point.device);
  insert.bind(point.quantity).bind(point.unit);
  insert.bind(std::int64_t{point.better == Direction::higher ? 1 : 0}).run();
  SqliteStatement find(file,
                       "SELECT id FROM series WHERE suite = ? AND quantity = ? AND scene = ? AND "
                       "method = ? AND budget = ? AND device = ?");
  find.bind(suite).bind(point.quantity).bind(point.scene).bind(point.method).bind(point.budget);
  find.bind(point.device).next();
  return find.integer(0);
}

void HistoryIndex::Database::add_run(const std::string& folder, const std::string& stamp,
                                     const Run& run) {
  const std::vector<RunPoint> run_points = points_of(run);
  const nlohmann::ordered_json& info = *run.info;
  const auto environment = info.value("environment", nlohmann::ordered_json::object());
  const std::string suite = text_at(info, "suite");
  const std::string machine =
      run.cells.empty() ? text_at(environment, "machine") : run.cells.front().machine;
  const auto dirty = environment.find("commit_dirty");
  const bool is_dirty = dirty != environment.end() && dirty->is_boolean() && dirty->get<bool>();
  SqliteStatement insert(file,
                         "INSERT INTO runs (folder, stamp, name, suite, profile, machine, utc, "
                         "revision, dirty) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(folder).bind(stamp).bind(run.folder.filename().string()).bind(suite);
  insert.bind(text_at(info, "profile")).bind(machine).bind(text_at(environment, "started_utc"));
  insert.bind(text_at(environment, "commit")).bind(std::int64_t{is_dirty ? 1 : 0}).run();
  const std::int64_t id = file.last_row();
  SqliteStatement add(file,
                      "INSERT OR REPLACE INTO points (series, run, value, low, high, count) "
                      "VALUES (?, ?, ?, ?, ?, ?)");
  for (const RunPoint& point : run_points) {
    add.bind(series_of(suite, point)).bind(id).bind(point.value.value).bind(point.value.low);
    add.bind(point.value.high).bind(static_cast<std::int64_t>(point.value.count)).run();
  }
}

std::vector<std::string> HistoryIndex::Database::texts(const char* sql, const std::string& suite) {
  SqliteStatement statement(file, sql);
  if (!suite.empty()) statement.bind(suite);
  std::vector<std::string> all;
  while (statement.next()) all.push_back(statement.text(0));
  return all;
}

HistoryIndex::HistoryIndex(const fs::path& results_root) : results_root_(results_root) {
  const fs::path path = results_root / "history.sqlite";
  std::error_code error;
  fs::create_directories(results_root, error);
  const bool can_write = ::access(results_root.c_str(), W_OK) == 0;
  // Without a place for it the index lives as long as the process.
  database_ = std::make_unique<Database>(can_write ? path : fs::path(":memory:"));
  try {
    database_->make_current();
  } catch (const base::InputError&) {
    const bool is_no_database = database_->file.is_no_database();
    const bool is_read_only = database_->file.cannot_be_written();
    if (!is_no_database && !is_read_only) throw;
    database_.reset();
    if (is_no_database) {
      fs::remove(path);
      fs::remove(path.string() + "-journal", error);
    }
    database_ = std::make_unique<Database>(is_read_only ? fs::path(":memory:") : path);
    database_->make_current();
  }
}

HistoryIndex::~HistoryIndex() = default;

HistoryIndex::Update HistoryIndex::update(bool rebuild) {
  Update update;
  Database& database = *database_;
  database.file.execute("BEGIN IMMEDIATE");
  std::map<std::string, std::string> known;
  {
    SqliteStatement runs(database.file, "SELECT folder, stamp FROM runs");
    while (runs.next()) known[runs.text(0)] = runs.text(1);
  }
  const fs::path runs = results_root_ / "runs";
  for (const std::string& folder : run_folders(runs)) {
    const auto found = known.find(folder);
    const std::string stamp = stamp_of(runs / folder);
    const bool is_known = found != known.end() && found->second == stamp && !rebuild;
    if (found != known.end() && !is_known) database.remove_run(folder);
    if (found != known.end()) known.erase(found);
    if (is_known) continue;
    try {
      if (run_kind(runs / folder) != "images") continue;
      const Run run = load_run(runs / folder);
      database.add_run(folder, stamp, run);
      ++update.read;
    } catch (const base::InputError& error) {
      update.unreadable.push_back(fmt::format("{}: {}", folder, error.what()));
    }
  }
  for (const auto& [folder, stamp] : known) {
    database.remove_run(folder);
    ++update.removed;
  }
  database.file.execute("COMMIT");
  return update;
}

namespace {

/// A run as points of it tell it, and its place among those of a query.
struct QueriedRun {
  std::size_t place = 0;  ///< by when it was made
  Point point;            ///< without a value
};

/// By their ids, which `least` is the smallest of.
struct QueriedRuns {
  std::unordered_map<std::int64_t, QueriedRun> by_id;
  std::int64_t least = 0;
};

QueriedRuns runs_of(SqliteFile& file, const Query& query) {
  SqliteStatement statement(file,
                            "SELECT id, name, utc, revision, dirty FROM runs WHERE suite = ? AND "
                            "profile = ? AND machine = ? ORDER BY name DESC LIMIT ?");
  const std::int64_t limit = query.last == 0 ? -1 : static_cast<std::int64_t>(query.last);
  statement.bind(query.suite).bind(query.profile).bind(query.machine).bind(limit);
  QueriedRuns runs;
  std::size_t place = std::numeric_limits<std::size_t>::max();
  while (statement.next()) {
    const std::int64_t id = statement.integer(0);
    runs.least = runs.by_id.empty() ? id : std::min(runs.least, id);
    Point point{
        statement.text(1), statement.text(2), statement.text(3), statement.integer(4) != 0, {}};
    runs.by_id.emplace(id, QueriedRun{place--, std::move(point)});
  }
  return runs;
}

}  // namespace

std::vector<Series> HistoryIndex::series(const Query& query) const {
  SqliteFile& file = database_->file;
  const QueriedRuns runs = runs_of(file, query);
  SqliteStatement heads(file,
                        "SELECT id, scene, method, budget, device, unit, higher FROM series WHERE "
                        "suite = ? AND quantity = ? ORDER BY id");
  heads.bind(query.suite).bind(query.quantity);
  SqliteStatement values(file,
                         "SELECT run, value, low, high, count FROM points WHERE series = ? AND "
                         "run >= ?");
  std::vector<Series> all;
  std::vector<std::pair<const QueriedRun*, Estimate>> found;
  while (heads.next()) {
    found.clear();
    values.bind(heads.integer(0)).bind(runs.least);
    while (values.next()) {
      const auto run = runs.by_id.find(values.integer(0));
      if (run == runs.by_id.end()) continue;
      found.emplace_back(&run->second, Estimate{values.real(1), values.real(2), values.real(3),
                                                static_cast<std::size_t>(values.integer(4))});
    }
    values.reset();
    if (found.empty()) continue;
    std::ranges::sort(found, {}, [](const auto& one) { return one.first->place; });
    Series& series =
        all.emplace_back(Series{heads.text(1),
                                heads.text(2),
                                heads.text(3),
                                heads.text(4),
                                heads.text(5),
                                heads.integer(6) != 0 ? Direction::higher : Direction::lower,
                                {}});
    series.points.reserve(found.size());
    for (const auto& [run, value] : found) {
      series.points.push_back(run->point);
      series.points.back().value = value;
    }
  }
  return all;
}

std::vector<std::string> HistoryIndex::suites() const {
  return database_->texts("SELECT DISTINCT suite FROM runs ORDER BY suite", "");
}

std::vector<std::string> HistoryIndex::quantities(const std::string& suite) const {
  return database_->texts(
      "SELECT DISTINCT quantity FROM series WHERE suite = ? AND EXISTS (SELECT 1 FROM points "
      "WHERE points.series = series.id) ORDER BY quantity",
      suite);
}

std::vector<std::string> HistoryIndex::machines(const std::string& suite) const {
  return database_->texts("SELECT DISTINCT machine FROM runs WHERE suite = ? ORDER BY machine",
                          suite);
}

std::vector<std::string> HistoryIndex::profiles(const std::string& suite,
                                                const std::string& machine) const {
  SqliteStatement statement(database_->file,
                            "SELECT profile FROM runs WHERE suite = ? AND machine = ? GROUP BY "
                            "profile ORDER BY MAX(name) DESC");
  statement.bind(suite).bind(machine);
  std::vector<std::string> all;
  while (statement.next()) all.push_back(statement.text(0));
  return all;
}

}  // namespace results::history

#include "results/history/sqlite_statement.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include "perception/base/errors.h"

namespace results::history {

SqliteFile::SqliteFile(const std::filesystem::path& path) : path_(path) {
  constexpr int kWaitForOthers_ms = 10000;
  if (sqlite3_open(path.string().c_str(), &handle_) != SQLITE_OK) {
    const std::string reason = handle_ != nullptr ? sqlite3_errmsg(handle_) : "out of memory";
    sqlite3_close(handle_);
    throw base::InputError({path.string()}, "cannot open: " + reason);
  }
  sqlite3_busy_timeout(handle_, kWaitForOthers_ms);
}

SqliteFile::~SqliteFile() { sqlite3_close(handle_); }

void SqliteFile::execute(const char* sql) {
  if (sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail(sql);
}

std::int64_t SqliteFile::last_row() const { return sqlite3_last_insert_rowid(handle_); }

void SqliteFile::fail(const std::string& action) const {
  throw base::InputError({path_.string()}, fmt::format("{}: {}", action, sqlite3_errmsg(handle_)));
}

bool SqliteFile::is_no_database() const {
  const int code = sqlite3_errcode(handle_);
  return code == SQLITE_NOTADB || code == SQLITE_CORRUPT;
}

bool SqliteFile::cannot_be_written() const {
  const int code = sqlite3_errcode(handle_);
  return code == SQLITE_READONLY || code == SQLITE_CANTOPEN || code == SQLITE_PERM;
}

SqliteStatement::SqliteStatement(SqliteFile& file, const char* sql) : file_(file) {
  if (sqlite3_prepare_v2(file.handle(), sql, -1, &statement_, nullptr) != SQLITE_OK) file.fail(sql);
}

SqliteStatement::~SqliteStatement() { sqlite3_finalize(statement_); }

SqliteStatement& SqliteStatement::bind(std::string_view text) {
  sqlite3_bind_text(statement_, ++bound_, text.data(), static_cast<int>(text.size()),
                    SQLITE_TRANSIENT);
  return *this;
}

SqliteStatement& SqliteStatement::bind(std::int64_t value) {
  sqlite3_bind_int64(statement_, ++bound_, value);
  return *this;
}

SqliteStatement& SqliteStatement::bind(double value) {
  sqlite3_bind_double(statement_, ++bound_, value);
  return *this;
}

bool SqliteStatement::next() {
  const int code = sqlite3_step(statement_);
  if (code != SQLITE_ROW && code != SQLITE_DONE) file_.fail("reading");
  return code == SQLITE_ROW;
}

void SqliteStatement::run() {
  while (next()) {
  }
  reset();
}

void SqliteStatement::reset() {
  sqlite3_reset(statement_);
  bound_ = 0;
}

std::string SqliteStatement::text(int column) const {
  const auto* bytes = sqlite3_column_text(statement_, column);
  return bytes == nullptr ? std::string() : reinterpret_cast<const char*>(bytes);
}

std::int64_t SqliteStatement::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}

double SqliteStatement::real(int column) const { return sqlite3_column_double(statement_, column); }

}  // namespace results::history

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace results::history {

/// An open SQLite file; closed at the end of the scope.
class SqliteFile {
 public:
  /// @throws base::InputError with the path and SQLite's reason
  explicit SqliteFile(const std::filesystem::path& path);
  ~SqliteFile();
  SqliteFile(const SqliteFile&) = delete;
  SqliteFile& operator=(const SqliteFile&) = delete;

  void execute(const char* sql);  ///< of statements without values and results
  std::int64_t last_row() const;
  [[noreturn]] void fail(const std::string& action) const;
  bool is_no_database() const;     ///< the last failure: the file is something else, or broken
  bool cannot_be_written() const;  ///< the last failure: it or its folder is read-only
  sqlite3* handle() const { return handle_; }

 private:
  std::filesystem::path path_;
  sqlite3* handle_ = nullptr;
};

/// A prepared statement: bind values in order, then step through its rows.
class SqliteStatement {
 public:
  SqliteStatement(SqliteFile& file, const char* sql);
  ~SqliteStatement();
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  SqliteStatement& bind(std::string_view text);
  SqliteStatement& bind(std::int64_t value);
  SqliteStatement& bind(double value);
  bool next();   ///< whether there is a row
  void run();    ///< to the end, then ready to be bound again
  void reset();  ///< ready to be bound again

  std::string text(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;

 private:
  SqliteFile& file_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
};

}  // namespace results::history

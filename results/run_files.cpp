#include "results/run_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "perception/base/names.h"

namespace results {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

bool ends_with_newline(int fd, off_t size) {
  char last = '\n';
  return size == 0 || (pread(fd, &last, 1, size - 1) == 1 && last == '\n');
}

/// Stops reading an object at the value of its key "cell".
class CellNameReader : public nlohmann::json_sax<ordered_json> {
 public:
  const std::string& name() const { return name_; }

  bool key(string_t& key) override {
    is_name_ = depth_ == 1 && key == "cell";
    return true;
  }
  bool string(string_t& value) override {
    if (is_name_) name_ = value;
    return !is_name_;
  }
  bool start_object(std::size_t) override { return enter(); }
  bool end_object() override { return leave(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_array() override { return leave(); }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

 private:
  bool enter() { return ++depth_ > 0; }
  bool leave() { return --depth_ >= 0; }
  std::string name_;
  int depth_ = 0;
  bool is_name_ = false;
};

}  // namespace

File::~File() {
  if (fd_ >= 0) close(fd_);
}

void fail_file(const fs::path& path, const std::string& action, int error) {
  throw base::InputError(
      fmt::format("{}: cannot {}: {}", path.string(), action, std::strerror(error)));
}

void append_line(const fs::path& path, std::string line) {
  const File file(open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  if (file.fd() < 0) fail_file(path, "append", errno);
  struct stat before {};
  if (fstat(file.fd(), &before) != 0) fail_file(path, "append", errno);
  line += '\n';
  if (!ends_with_newline(file.fd(), before.st_size)) line.insert(0, 1, '\n');

  const ssize_t written = write(file.fd(), line.data(), line.size());
  if (written < 0) fail_file(path, "append", errno);
  if (static_cast<std::size_t>(written) < line.size()) {
    // The disk is full: take back the part that was written.
    if (ftruncate(file.fd(), before.st_size) != 0) fail_file(path, "take back half a line", errno);
    fail_file(path, "append", ENOSPC);
  }
  if (fdatasync(file.fd()) != 0 && errno != EINVAL) fail_file(path, "flush to the disk", errno);
}

std::size_t read_lines(const fs::path& path, const std::function<void(const ordered_json&)>& use) {
  std::ifstream file(path);
  std::size_t unreadable = 0;
  int line_number = 0;
  for (std::string line; std::getline(file, line);) {
    ++line_number;
    if (line.empty()) continue;
    const ordered_json json = ordered_json::parse(line, nullptr, false);
    if (json.is_discarded()) {
      ++unreadable;
      continue;
    }
    try {
      use(json);
    } catch (const base::InputError& error) {
      throw base::InputError(base::Place{path.string(), line_number, 0}, error.what());
    }
  }
  return unreadable;
}

void read_cell_names(const fs::path& folder, const std::function<void(const std::string&)>& use) {
  const fs::path path = folder / "cells.jsonl";
  if (!fs::exists(path)) return;
  std::ifstream file(path);
  if (!file) fail_file(path, "read", errno);
  for (std::string line; std::getline(file, line);) {
    CellNameReader reader;
    ordered_json::sax_parse(line, &reader);
    if (!reader.name().empty()) use(reader.name());
  }
  if (file.bad()) fail_file(path, "read", errno);
}

void append_file(const fs::path& from, const fs::path& to) {
  if (!fs::exists(from)) return;
  std::ifstream source(from, std::ios::binary);
  if (!source) fail_file(from, "read", errno);
  std::ofstream target(to, std::ios::binary | std::ios::app);
  for (std::string line; std::getline(source, line);) target << line << '\n';
  if (source.bad()) fail_file(from, "read", errno);
  target.close();
  if (!target) fail_file(to, "append", errno);
}

std::string text_or_empty(const fs::path& path) {
  return fs::exists(path) ? base::read_text_file(path) : std::string();
}

ordered_json read_run_json(const fs::path& folder) {
  const fs::path path = folder / "run.json";
  const std::string text = text_or_empty(path);
  if (text.empty()) return ordered_json::object();
  ordered_json json = ordered_json::parse(text, nullptr, false);
  if (!json.is_object()) {
    throw base::InputError(fmt::format("{}: not a JSON object; is it a run?", path.string()));
  }
  return json;
}

std::string path_name(const ordered_json& info, const char* key, const fs::path& run_folder) {
  const auto found = info.find(key);
  if (found == info.end() || found->is_null()) return "";
  const std::string name = found->is_string() ? found->get<std::string>() : found->dump();
  if (name.empty() || base::is_path_safe(name)) return name;
  throw base::InputError(
      {(run_folder / "run.json").string()},
      fmt::format("{} \"{}\" cannot be a file name; accepted: letters, digits, . _ -, not "
                  "starting with . or -",
                  key, name));
}

namespace {

/// Cells that a worker renders one after the other share its log: all but the first link to it. A
/// run that was killed while it took away empty logs may have left a link to none.
bool is_log_of_another_cell(const fs::path& link, const fs::path& run_folder) {
  const fs::path name = link.filename();
  if (name != "stdout.log" && name != "stderr.log") return false;
  if (link.parent_path().parent_path() != run_folder / "images") return false;
  std::error_code error;
  const fs::path target = fs::read_symlink(link, error);
  const fs::path cell = target.parent_path();
  const fs::path there = link.parent_path() / target;
  if (error || target.filename() != name || cell.parent_path() != ".." || cell.filename() == ".." ||
      cell.filename() == ".") {
    return false;
  }
  const fs::file_status log = fs::symlink_status(there, error);
  return fs::is_regular_file(log) || log.type() == fs::file_type::not_found;
}

}  // namespace

void require_no_links(const fs::path& run_folder) {
  const auto require_none = [&](const fs::directory_entry& entry) {
    std::error_code error;
    if (!entry.is_symlink(error) || is_log_of_another_cell(entry.path(), run_folder)) return;
    throw base::InputError({entry.path().string()},
                           "is a symbolic link; a run is written within its own folder: put the "
                           "file or folder itself there");
  };
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(run_folder, error)) {
    require_none(entry);
  }
  for (const char* name : {"images", "maps", "report", "figures"}) {
    for (const fs::directory_entry& entry :
         fs::recursive_directory_iterator(run_folder / name, error)) {
      require_none(entry);
    }
  }
}

fs::path results_root_of(const fs::path& run_folder) { return run_folder / "../../.."; }

fs::path reference_file(const fs::path& run_folder, const std::string& hash) {
  return results_root_of(run_folder) / "references" / hash / "reference.exr";
}

void require_run(const fs::path& folder) {
  if (fs::exists(folder / "run.json") || fs::exists(folder / "cells.jsonl")) return;
  throw base::InputError(
      fmt::format("{}: not a run; a run folder holds run.json and cells.jsonl", folder.string()));
}

}  // namespace results

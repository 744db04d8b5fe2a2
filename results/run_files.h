#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace results {

/// Closes a descriptor at the end of the scope.
class File {
 public:
  explicit File(int fd) : fd_(fd) {}
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int fd() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

/// @throws base::InputError "<path>: cannot <action>: <reason of errno's value>"
[[noreturn]] void fail_file(const std::filesystem::path& path, const std::string& action,
                            int error);

/// Appends a line with one write call, so that other readers never see two lines mixed, and flushes
/// it; a line that an earlier process left cut is ended first.
/// @throws base::InputError with the system's reason; nothing is left half-written
void append_line(const std::filesystem::path& path, std::string line);

/// Calls use(json) for every line; returns how many are not JSON, i.e. were cut by a crash.
/// @throws base::InputError with file and line for what `use` refuses
std::size_t read_lines(const std::filesystem::path& path,
                       const std::function<void(const nlohmann::ordered_json&)>& use);

/// Calls use(cell) for every line of a folder's cells.jsonl, in order; what a crash cut is passed
/// over. Reads no more of a line than it must. @throws base::InputError with the system's reason
void read_cell_names(const std::filesystem::path& folder,
                     const std::function<void(const std::string& cell)>& use);

/// Appends the bytes of a file of lines to another, which is made if it is missing, and ends its
/// last line; nothing is done if there is no such file.
/// @throws base::InputError with the system's reason
void append_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// @return "" for a file that is not there
std::string text_or_empty(const std::filesystem::path& path);

/// run.json of a folder; an empty object if there is none yet.
nlohmann::ordered_json read_run_json(const std::filesystem::path& folder);

/// A name in run.json that becomes part of a path; "" if it is not there.
/// @throws base::InputError if it could lead out of the folder: runs come from other machines
std::string path_name(const nlohmann::ordered_json& info, const char* key,
                      const std::filesystem::path& run_folder);

/// What is written into a run stays in its folder.
/// @throws base::InputError if an entry of the folder, or what is below its images, maps, report or
///   figures, is a symbolic link, but for a cell's log that is that of another cell
void require_no_links(const std::filesystem::path& run_folder);

/// The results folder that a run is in: <results>/runs/<suite>/<run>.
std::filesystem::path results_root_of(const std::filesystem::path& run_folder);
/// <results>/references/<hash>/reference.exr of that folder; it need not be there.
std::filesystem::path reference_file(const std::filesystem::path& run_folder,
                                     const std::string& hash);

/// @throws base::InputError if the folder holds neither run.json nor cells.jsonl
void require_run(const std::filesystem::path& folder);

/// Takes lines in as they come; a later one of the same key replaces the earlier one in place.
template <class Record, class Key>
class LastOfEachKey {
 public:
  explicit LastOfEachKey(std::vector<Record>& records) : records_(records) {}
  void add(const Key& key, Record record) {
    const auto [entry, is_new] = index_of_.emplace(key, records_.size());
    if (is_new) records_.emplace_back();
    records_[entry->second] = std::move(record);
  }

 private:
  std::vector<Record>& records_;
  std::map<Key, std::size_t> index_of_;
};

}  // namespace results

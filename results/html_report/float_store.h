#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace results::html_report {

/// Whether a report is one file, or an index with files of data beside it.
enum class Split { automatic, always, never };

/// Above this a report of Split::automatic is split.
inline constexpr std::uint64_t kSplitAboveBytes = 300'000'000;

/// The float images of a page: in memory until they outgrow the limit, then one file each.
///
/// May be filled from several threads at once; the result does not depend on their order.
class FloatStore {
 public:
  /// @param folder  of the page: files go to <folder>/data/; empty with Split::never only
  FloatStore(Split split, std::filesystem::path folder,
             std::uint64_t split_above_bytes = kSplitAboveBytes);

  /// Keeps the data of image `id`, a number of the caller's own: 0, 1, 2, ...
  /// @param base64  of FloatPayload::deflated
  void put(std::size_t id, std::string base64);

  /// Call it once, after the last put: the files of a split page take their place, those of an
  /// earlier one go. @throws base::InputError with the system's reason
  void finish();

  /// Keeps a small file of a split page beside the data. @return its path from the page's folder
  std::string put_file(const std::string& name, const std::string& bytes) const;

  bool is_split() const { return is_split_; }
  std::uint64_t bytes() const { return bytes_; }  ///< of all data, as text

  /// Elements that hold the data of an unsplit page, for the end of its body; "" if split.
  std::string elements() const;

 private:
  void spill();
  void write(std::size_t id) const;

  std::filesystem::path folder_;
  std::uint64_t split_above_bytes_;
  bool may_split_;
  bool is_split_;
  std::uint64_t bytes_ = 0;
  std::vector<std::string> texts_;  ///< by number; "" where there is none, or once it is written
  std::mutex mutex_;
};

}  // namespace results::html_report

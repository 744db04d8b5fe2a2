#pragma once

#include <filesystem>
#include <functional>

namespace suites {

/// An advisory lock on a file that is made if it is missing; freed with the object, or by the
/// system when the process ends.
class FileLock {
 public:
  /// Waits for the lock.
  /// @param may_wait  asked about every 100 ms while another process holds it; false: give up
  /// @throws base::InputError if the file cannot be made; Interrupted if it gave up
  FileLock(const std::filesystem::path& path, const std::function<bool()>& may_wait);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int fd_ = -1;
};

}  // namespace suites

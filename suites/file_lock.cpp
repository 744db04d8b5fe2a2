#include "suites/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "suites/interruption.h"

namespace suites {
namespace {

constexpr std::chrono::milliseconds kPollPeriod{100};

}  // namespace

FileLock::FileLock(const std::filesystem::path& path, const std::function<bool()>& may_wait)
    : fd_(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
  if (fd_ < 0) {
    throw base::InputError(
        fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
  }
  while (flock(fd_, LOCK_EX | LOCK_NB) != 0) {
    if (may_wait && !may_wait()) {
      close(fd_);
      throw Interrupted();
    }
    std::this_thread::sleep_for(kPollPeriod);
  }
}

FileLock::~FileLock() { close(fd_); }

}  // namespace suites

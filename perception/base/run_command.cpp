#include <unistd.h>

#include <cstdlib>
#include <string_view>
#include <thread>

#include "perception/base/atomic_file.h"
#include "perception/base/child_process.h"
#include "perception/base/errors.h"

namespace base {

namespace {

/// A file in the temporary folder that goes with the object.
class TemporaryFile {
 public:
  TemporaryFile() : path_((std::filesystem::temp_directory_path() / "discern-XXXXXX").string()) {
    const int fd = mkstemp(path_.data());
    if (fd < 0) throw DeviceError(path_ + ": no temporary file can be made");
    close(fd);
  }
  ~TemporaryFile() { unlink(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

CommandResult run_command(const std::vector<std::string>& arguments,
                          std::chrono::duration<double> timeout,
                          const std::vector<std::pair<std::string, std::string>>& environment) {
  const TemporaryFile out;
  const TemporaryFile err;
  ChildProcess child({arguments, out.path(), err.path(), false, environment});
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  CommandResult result;
  std::optional<ExitState> exit = child.try_wait();
  while (!exit && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    exit = child.try_wait();
  }
  result.timed_out = !exit.has_value();
  result.exit = exit ? *exit : child.stop(std::chrono::duration<double>(0.5));
  result.stdout_text = read_text_file(out.path());
  result.stderr_text = read_text_file(err.path());
  return result;
}

std::filesystem::path executable_path() {
  constexpr std::string_view kReplaced = " (deleted)";
  std::string path = std::filesystem::read_symlink(this_program()).string();
  if (path.ends_with(kReplaced)) path.resize(path.size() - kReplaced.size());
  return path;
}

std::filesystem::path this_program() { return "/proc/self/exe"; }

}  // namespace base

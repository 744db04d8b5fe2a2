#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace base {

/// How a child process ended.
struct ExitState {
  int code = 0;              ///< exit code if it ended by itself
  int signal = 0;            ///< signal number if it was killed, else 0
  std::string text() const;  ///< "exit code 3", "signal 11 (Segmentation fault)"
};

/// A child process in a process group of its own that dies with its parent.
///
/// Talks over one socket pair, line by line; stdout and stderr are appended to files, stdin is
/// empty. Start it on a thread that lives as long as the child: the kernel ties the two together.
class ChildProcess {
 public:
  struct Options {
    std::vector<std::string> arguments;  ///< argv, [0] is a path, or a name in $PATH
    std::filesystem::path stdout_file;   ///< empty: inherited
    std::filesystem::path stderr_file;   ///< empty: inherited
    bool with_channel = false;           ///< socket pair; the child finds its end at kChannelFd
    std::vector<std::pair<std::string, std::string>> environment;  ///< added to the parent's
  };
  static constexpr int kChannelFd = 3;

  /// @throws DeviceError if the process cannot be started
  explicit ChildProcess(const Options& options);
  ~ChildProcess();  ///< kills the group if it still runs
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }

  /// Writes one line to the channel. @return false if the child is gone
  bool send_line(const std::string& line);

  enum class Wait { line, closed, timeout, interrupted };
  /// Waits for one line from the channel.
  /// @param poll  called about every 50 ms; returns false to stop waiting (interrupted)
  Wait receive_line(std::string& line, std::chrono::duration<double> timeout,
                    const std::function<bool()>& poll = {});

  /// Resident set size of the process now, bytes; 0 once it is gone.
  std::int64_t resident_bytes() const;
  /// True and the state if it has ended.
  std::optional<ExitState> try_wait();
  ExitState wait();
  /// TERM to the group, then KILL after the grace period; returns its end.
  ExitState stop(std::chrono::duration<double> grace);

 private:
  pid_t pid_ = -1;
  int channel_ = -1;
  std::string received_;
  std::optional<ExitState> exit_;
};

/// Result of a command run to its end.
struct CommandResult {
  ExitState exit;
  bool timed_out = false;
  std::string stdout_text;
  std::string stderr_text;
};

/// Runs a command to its end and collects what it prints.
CommandResult run_command(const std::vector<std::string>& arguments,
                          std::chrono::duration<double> timeout,
                          const std::vector<std::pair<std::string, std::string>>& environment = {});

/// The running executable's path when it was started; a build may have put another file there.
std::filesystem::path executable_path();
/// Names the running program itself, to read it or to start it again, whatever lies at its path by
/// now.
std::filesystem::path this_program();

/// Peak resident size of this process, bytes.
std::int64_t peak_resident_bytes();

}  // namespace base

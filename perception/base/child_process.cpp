#include "perception/base/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "perception/base/errors.h"

extern char** environ;

namespace base {

namespace {

using Seconds = std::chrono::duration<double>;

/// argv or envp of a vector of strings that outlives it.
std::vector<char*> pointers_of(std::vector<std::string>& strings) {
  std::vector<char*> pointers;
  for (std::string& text : strings) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> environment_with(
    const std::vector<std::pair<std::string, std::string>>& added) {
  std::vector<std::string> variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view variable(*entry);
    const bool is_replaced = std::any_of(added.begin(), added.end(), [&](const auto& pair) {
      return variable.starts_with(pair.first + "=");
    });
    if (!is_replaced) variables.emplace_back(variable);
  }
  for (const auto& [name, value] : added) variables.push_back(name + "=" + value);
  return variables;
}

int open_output(const std::filesystem::path& path) {
  if (path.empty()) return -1;
  const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (fd < 0) {
    throw InputError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
  }
  return fd;
}

/// What the child does between fork and exec; async-signal-safe calls only.
struct ChildSetUp {
  int in = -1;
  int out = -1;
  int err = -1;
  int channel = -1;
  pid_t parent = -1;
  char** arguments = nullptr;
  char** environment = nullptr;

  [[noreturn]] void run() const {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    signal(SIGINT, SIG_IGN);
    dup2(in, STDIN_FILENO);
    if (out >= 0) dup2(out, STDOUT_FILENO);
    if (err >= 0) dup2(err, STDERR_FILENO);
    if (channel == ChildProcess::kChannelFd) {
      fcntl(channel, F_SETFD, 0);
    } else if (channel >= 0) {
      dup2(channel, ChildProcess::kChannelFd);
    }
    execve(arguments[0], arguments, environment);
    _exit(127);
  }
};

/// The program's path; a bare name is looked up in $PATH.
std::filesystem::path find_executable(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  const char* path_variable = std::getenv("PATH");
  std::istringstream folders(path_variable != nullptr ? path_variable : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path candidate = std::filesystem::path(folder) / name;
    if (access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  throw DeviceError(fmt::format("{}: no such program in $PATH", name));
}

ExitState exit_state_of(int status) {
  ExitState state;
  if (WIFSIGNALED(status)) {
    state.signal = WTERMSIG(status);
  } else {
    state.code = WEXITSTATUS(status);
  }
  return state;
}

/// Resident bytes of one process, from /proc/<pid>/statm.
std::int64_t resident_bytes_of(pid_t pid) {
  std::ifstream statm(fmt::format("/proc/{}/statm", pid));
  std::int64_t total_pages = 0;
  std::int64_t resident_pages = 0;
  if (!(statm >> total_pages >> resident_pages)) return 0;
  return resident_pages * sysconf(_SC_PAGESIZE);
}

}  // namespace

std::string ExitState::text() const {
  if (signal != 0) return fmt::format("signal {} ({})", signal, strsignal(signal));
  return fmt::format("exit code {}", code);
}

ChildProcess::ChildProcess(const Options& options) {
  std::vector<std::string> arguments = options.arguments;
  std::vector<std::string> variables = environment_with(options.environment);
  arguments.at(0) = find_executable(arguments[0]).string();
  std::vector<char*> argv = pointers_of(arguments);
  std::vector<char*> envp = pointers_of(variables);
  std::array<int, 2> sockets{-1, -1};
  if (options.with_channel &&
      socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0) {
    throw DeviceError(fmt::format("no socket pair for a worker: {}", std::strerror(errno)));
  }
  ChildSetUp set_up;
  set_up.in = open("/dev/null", O_RDONLY | O_CLOEXEC);
  set_up.out = open_output(options.stdout_file);
  set_up.err = open_output(options.stderr_file);
  set_up.channel = sockets[1];
  set_up.parent = getpid();
  set_up.arguments = argv.data();
  set_up.environment = envp.data();

  pid_ = fork();
  if (pid_ == 0) set_up.run();
  const int fork_error = errno;
  if (pid_ > 0) setpgid(pid_, pid_);
  for (const int fd : {set_up.in, set_up.out, set_up.err, sockets[1]}) {
    if (fd >= 0) close(fd);
  }
  channel_ = sockets[0];
  if (pid_ < 0) {
    if (channel_ >= 0) close(channel_);
    throw DeviceError(
        fmt::format("{}: cannot be started: {}", arguments[0], std::strerror(fork_error)));
  }
}

ChildProcess::~ChildProcess() {
  if (!exit_) stop(Seconds(0.0));
  if (channel_ >= 0) close(channel_);
}

bool ChildProcess::send_line(const std::string& line) {
  const std::string text = line + '\n';
  std::size_t sent = 0;
  while (sent < text.size()) {
    const ssize_t count = send(channel_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

ChildProcess::Wait ChildProcess::receive_line(std::string& line, Seconds timeout,
                                              const std::function<bool()>& poll_callback) {
  constexpr int kPollPeriod_ms = 50;
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  std::array<char, 65536> buffer{};
  for (;;) {
    const std::size_t end = received_.find('\n');
    if (end != std::string::npos) {
      line = received_.substr(0, end);
      received_.erase(0, end + 1);
      return Wait::line;
    }
    if (poll_callback && !poll_callback()) return Wait::interrupted;
    if (std::chrono::steady_clock::now() >= deadline) return Wait::timeout;
    pollfd entry{channel_, POLLIN, 0};
    if (poll(&entry, 1, kPollPeriod_ms) <= 0) continue;
    const ssize_t count = read(channel_, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return Wait::closed;
    received_.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

std::int64_t ChildProcess::resident_bytes() const { return exit_ ? 0 : resident_bytes_of(pid_); }

std::optional<ExitState> ChildProcess::try_wait() {
  if (exit_) return exit_;
  int status = 0;
  const pid_t ended = waitpid(pid_, &status, WNOHANG);
  if (ended == pid_) exit_ = exit_state_of(status);
  return exit_;
}

ExitState ChildProcess::wait() {
  if (exit_) return *exit_;
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  exit_ = exit_state_of(status);
  return *exit_;
}

ExitState ChildProcess::stop(Seconds grace) {
  if (exit_) return *exit_;
  kill(-pid_, SIGTERM);
  const auto deadline = std::chrono::steady_clock::now() + grace;
  while (std::chrono::steady_clock::now() < deadline) {
    if (try_wait()) return *exit_;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  kill(-pid_, SIGKILL);
  return wait();
}

std::int64_t peak_resident_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace base

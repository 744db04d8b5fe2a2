#include "perception/base/parent_channel.h"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "perception/base/errors.h"

namespace base {

ParentChannel::ParentChannel(int fd) : fd_(fd) {}

std::optional<std::string> ParentChannel::receive_line() {
  std::array<char, 4096> buffer{};
  for (;;) {
    const std::size_t end = received_.find('\n');
    if (end != std::string::npos) {
      std::string line = received_.substr(0, end);
      received_.erase(0, end + 1);
      return line;
    }
    const ssize_t count = read(fd_, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::nullopt;
    received_.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

void ParentChannel::send_line(const std::string& line) {
  const std::string text = line + '\n';
  std::size_t sent = 0;
  while (sent < text.size()) {
    const ssize_t count = send(fd_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw DeviceError("the harness that started this worker is gone");
    sent += static_cast<std::size_t>(count);
  }
}

}  // namespace base

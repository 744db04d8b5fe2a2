#pragma once

#include <optional>
#include <string>

namespace base {

/// The child's side of the channel: a line in, a line out.
class ParentChannel {
 public:
  explicit ParentChannel(int fd);
  std::optional<std::string> receive_line();  ///< nothing once the parent is gone
  void send_line(const std::string& line);

 private:
  int fd_;
  std::string received_;
};

}  // namespace base

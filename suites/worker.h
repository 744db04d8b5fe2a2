#pragma once

namespace suites {

/// Serves repetitions of one scene and method over a channel until it closes; the hidden verb
/// `worker`. One job per line in, one reply per line out (worker_protocol.h).
///
/// @param channel_fd  this end of the socket pair, usually base::ChildProcess::kChannelFd
/// @return exit code: 0, or 2 if the channel breaks
int serve_worker(int channel_fd);

}  // namespace suites

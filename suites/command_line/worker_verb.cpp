#include "perception/base/child_process.h"
#include "suites/command_line/verbs.h"
#include "suites/suite_runner.h"

namespace suites::command_line {

int run_worker(const WorkerArguments&, Console&) {
  return serve_worker(base::ChildProcess::kChannelFd);
}

}  // namespace suites::command_line

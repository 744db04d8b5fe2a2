// The smallest program that serves repetitions, so that the tests of the harness need no other.

#include "perception/base/child_process.h"
#include "suites/worker.h"

int main() { return suites::serve_worker(base::ChildProcess::kChannelFd); }

#include "suites/job_cores.h"

#include <sched.h>

#include <exception>
#include <mutex>
#include <thread>

#include "perception/base/errors.h"

namespace suites {

namespace {

void pin_this_thread(const std::vector<int>& cores) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int core : cores) CPU_SET(static_cast<unsigned>(core), &set);
  if (sched_setaffinity(0, sizeof set, &set) != 0) {
    throw base::DeviceError("a thread could not be kept on cores of its own");
  }
}

}  // namespace

std::vector<int> available_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> cores;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return {0};
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(static_cast<unsigned>(core), &set)) cores.push_back(core);
  }
  return cores;
}

std::vector<std::vector<int>> cores_of_jobs(const std::vector<int>& cores, int jobs) {
  std::vector<std::vector<int>> parts(static_cast<std::size_t>(jobs));
  for (std::size_t i = 0; i < cores.size(); ++i) {
    parts[i * parts.size() / cores.size()].push_back(cores[i]);
  }
  return parts;
}

void run_on_cores(const std::vector<int>& cores, const std::function<void()>& work) {
  run_jobs(
      {cores}, [&work](int) { work(); }, [] {});
}

void run_jobs(const std::vector<std::vector<int>>& cores, const std::function<void(int job)>& work,
              const std::function<void()>& stop) {
  std::exception_ptr first_failure;
  std::mutex mutex;
  const auto run_one = [&](int job) {
    try {
      pin_this_thread(cores[static_cast<std::size_t>(job)]);
      work(job);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!first_failure) first_failure = std::current_exception();
      stop();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t job = 0; job < cores.size(); ++job) {
      threads.emplace_back(run_one, static_cast<int>(job));
    }
  }
  if (first_failure) std::rethrow_exception(first_failure);
}

}  // namespace suites

#pragma once

#include <functional>
#include <vector>

/// Work that runs side by side, each part on cores of its own.
namespace suites {

/// Numbers of the cores that the calling thread may run on, ascending.
std::vector<int> available_cores();

/// Deals cores to jobs in contiguous parts that differ by at most one core.
/// @param jobs  1 to as many as there are cores
std::vector<std::vector<int>> cores_of_jobs(const std::vector<int>& cores, int jobs);

/// Calls `work` on a new thread that runs on these cores alone, and so do the processes that it
/// starts. Returns when it ended; rethrows what it threw.
void run_on_cores(const std::vector<int>& cores, const std::function<void()>& work);

/// Calls work(0) ... work(jobs - 1) at once, each as `run_on_cores` does.
/// @param stop  called when one of them threw: the others should end soon
/// Rethrows what the first one threw.
void run_jobs(const std::vector<std::vector<int>>& cores, const std::function<void(int job)>& work,
              const std::function<void()>& stop);

}  // namespace suites

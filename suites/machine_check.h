#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace suites {

/// One thing that times depend on, as this machine has it.
struct MachineFinding {
  enum class State {
    good,
    unknown,  ///< cannot be seen from here, e.g. in a virtual machine
    warning,  ///< times will be noisier, or of something else as well
    problem   ///< nothing can be measured
  };
  std::string name;  ///< "governor"
  State state = State::good;
  std::string found;  ///< "powersave"
  std::string cure;   ///< what to do about a warning or a problem; "" else
};
std::string to_string(MachineFinding::State state);

/// Files that Linux tells of a machine; another folder in tests.
struct MachineFiles {
  std::filesystem::path root = "/";
};

/// Clock governor, turbo, clock source, load, steal time of the hypervisor, CPU quota, free and
/// swapped memory, as the files say. Takes a quarter of a second for steal.
std::vector<MachineFinding> check_machine(const MachineFiles& files);

/// Whether a results folder can be written and has room.
MachineFinding check_results_folder(const std::filesystem::path& root);

/// How far the times of the same work spread here: the half width of the middle 90 % of the canary,
/// of its median.
MachineFinding check_steadiness();

}  // namespace suites

#include "suites/machine_check.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "perception/base/atomic_file.h"
#include "perception/base/available_memory.h"
#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "perception/base/quantile.h"
#include "perception/base/units.h"
#include "suites/canary.h"

namespace suites {

namespace fs = std::filesystem;

namespace {

using State = MachineFinding::State;

/// A file of /proc or /sys as one text without the last newline; nothing if it is not there.
std::optional<std::string> read(const MachineFiles& files, const char* path) {
  try {
    std::string text = base::read_text_file(files.root / path);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
  } catch (const base::InputError&) {
    return std::nullopt;
  }
}

MachineFinding unknown(const char* name) {
  return {name, State::unknown, "not visible, as in a virtual machine", ""};
}

MachineFinding check_governor(const MachineFiles& files) {
  const auto governor = read(files, "sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  if (!governor) return unknown("governor");
  if (*governor == "performance") return {"governor", State::good, *governor, ""};
  return {"governor", State::warning, *governor,
          "sudo cpupower frequency-set --governor performance"};
}

MachineFinding check_turbo(const MachineFiles& files) {
  if (const auto off = read(files, "sys/devices/system/cpu/intel_pstate/no_turbo")) {
    if (*off == "1") return {"turbo", State::good, "off", ""};
    return {"turbo", State::warning, "on: the clock follows the temperature",
            "echo 1 | sudo tee /sys/devices/system/cpu/intel_pstate/no_turbo"};
  }
  if (const auto boost = read(files, "sys/devices/system/cpu/cpufreq/boost")) {
    if (*boost == "0") return {"turbo", State::good, "off", ""};
    return {"turbo", State::warning, "on: the clock follows the temperature",
            "echo 0 | sudo tee /sys/devices/system/cpu/cpufreq/boost"};
  }
  return unknown("turbo");
}

MachineFinding check_clock_source(const MachineFiles& files) {
  const auto source =
      read(files, "sys/devices/system/clocksource/clocksource0/current_clocksource");
  if (!source) return unknown("clock source");
  const bool is_slow = *source == "hpet" || *source == "acpi_pm" || *source == "jiffies";
  if (!is_slow) return {"clock source", State::good, *source, ""};
  return {"clock source", State::warning, *source + ": reading it takes a microsecond",
          "boot with clocksource=tsc, or the hypervisor's own clock"};
}

MachineFinding check_load(const MachineFiles& files) {
  constexpr double kIdleShare = 0.1;  // of a core per core; ours
  const auto text = read(files, "proc/loadavg");
  if (!text) return unknown("load");
  const double load = std::strtod(text->c_str(), nullptr);
  const int cores = base::core_count();
  const std::string found = fmt::format("{:.2f} on {} cores", load, cores);
  if (load <= kIdleShare * cores) return {"load", State::good, found, ""};
  return {"load", State::warning, found, "end other work, or wait a minute and look again"};
}

/// Total and stolen time of all cores, in ticks.
struct CpuTicks {
  double all = 0.0;
  double stolen = 0.0;
};

std::optional<CpuTicks> cpu_ticks(const MachineFiles& files) {
  constexpr int kSteal = 7;  // columns of "cpu": proc(5)
  const auto text = read(files, "proc/stat");
  if (!text || !text->starts_with("cpu ")) return std::nullopt;
  std::istringstream line(text->substr(4, text->find('\n') - 4));
  CpuTicks ticks;
  double value = 0.0;
  for (int column = 0; line >> value; ++column) {
    ticks.all += value;
    if (column == kSteal) ticks.stolen = value;
  }
  return ticks;
}

MachineFinding check_steal(const MachineFiles& files) {
  constexpr double kMostStolen = 0.01;
  const auto before = cpu_ticks(files);
  std::this_thread::sleep_for(std::chrono::milliseconds(250));
  const auto after = cpu_ticks(files);
  if (!before || !after) return unknown("steal");
  const double all = after->all - before->all;
  const double share = all > 0.0 ? (after->stolen - before->stolen) / all : 0.0;
  const std::string found = fmt::format("{:.1f} % of the time went to other machines", 100 * share);
  if (share <= kMostStolen) return {"steal", State::good, found, ""};
  return {"steal", State::warning, found, "use a host that does not share its cores"};
}

MachineFinding check_quota(const MachineFiles& files) {
  const auto text = read(files, "sys/fs/cgroup/cpu.max");
  const int cores = base::core_count();
  if (!text || text->starts_with("max")) {
    return {"cores", State::good, fmt::format("{}", cores), ""};
  }
  std::istringstream fields(*text);
  double quota = 0.0;
  double period = 1.0;
  fields >> quota >> period;
  const double allowed = quota / period;
  const std::string found = fmt::format("{:.1f} of {} cores by quota", allowed, cores);
  if (allowed >= cores) return {"cores", State::good, found, ""};
  return {"cores", State::warning, found + ": work is stopped when it is used up",
          fmt::format("raise the quota of the container, or run with --threads {}",
                      std::max(1, static_cast<int>(allowed)))};
}

void check_memory(const MachineFiles& files, std::vector<MachineFinding>& findings) {
  constexpr double kEnough_bytes = 4.0 * (1U << 30U);
  const auto text = read(files, "proc/meminfo");
  const auto available = text ? base::meminfo_bytes(*text, "MemAvailable") : std::nullopt;
  if (!available) {
    findings.push_back(unknown("memory"));
    return;
  }
  const std::string found = base::format_bytes(*available) + " free";
  findings.push_back(*available >= kEnough_bytes
                         ? MachineFinding{"memory", State::good, found, ""}
                         : MachineFinding{"memory", State::warning, found,
                                          "end other programs; a worker may take 8 GiB"});
  const double swapped = base::meminfo_bytes(*text, "SwapTotal").value_or(0.0) -
                         base::meminfo_bytes(*text, "SwapFree").value_or(0.0);
  constexpr double kLittle_bytes = 64.0 * (1U << 20U);
  findings.push_back(swapped <= kLittle_bytes
                         ? MachineFinding{"swap", State::good, "not in use", ""}
                         : MachineFinding{"swap", State::warning,
                                          base::format_bytes(swapped) + " in use",
                                          "sudo swapoff -a && sudo swapon -a"});
}

}  // namespace

std::string to_string(State state) {
  switch (state) {
    case State::good:
      return "good";
    case State::unknown:
      return "unknown";
    case State::warning:
      return "warning";
    case State::problem:
      break;
  }
  return "problem";
}

std::vector<MachineFinding> check_machine(const MachineFiles& files) {
  std::vector<MachineFinding> findings{check_governor(files),     check_turbo(files),
                                       check_clock_source(files), check_load(files),
                                       check_steal(files),        check_quota(files)};
  check_memory(files, findings);
  return findings;
}

MachineFinding check_results_folder(const fs::path& root) {
  constexpr double kEnough_bytes = 5.0 * (1U << 30U);
  try {
    fs::create_directories(root);
    const fs::path probe = root / ".doctor";
    base::write_text_file(probe, "writable\n");
    fs::remove(probe);
  } catch (const std::exception& error) {
    return {"results folder", State::problem, error.what(),
            "--results DIR or DISCERN_RESULTS with a folder that can be written"};
  }
  const double free_bytes = static_cast<double>(fs::space(root).available);
  const std::string found =
      fmt::format("{}, {} free", root.string(), base::format_bytes(free_bytes));
  if (free_bytes >= kEnough_bytes) return {"results folder", State::good, found, ""};
  return {"results folder", State::warning, found,
          "remove old run folders; their numbers stay in accepted baselines"};
}

MachineFinding check_steadiness() {
  constexpr int kRuns = 50;
  constexpr double kMostSpread = 0.05;
  const Canary canary;
  std::vector<double> times;
  for (int i = 0; i < kRuns; ++i) times.push_back(canary.run().wall_s);
  const double spread =
      0.5 * (base::quantile(times, 0.95) - base::quantile(times, 0.05)) / base::median(times);
  const std::string found = fmt::format("the same {:.1f} ms of work spread by ±{:.1f} %",
                                        1e3 * base::median(times), 100.0 * spread);
  if (spread <= kMostSpread) return {"steadiness", State::good, found, ""};
  return {"steadiness", State::warning, found,
          "more repetitions (measure: {repetitions: {max: 30, until: 2%}}), an idle machine"};
}

}  // namespace suites

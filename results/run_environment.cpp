#include "results/run_environment.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include <nlohmann/json.hpp>

#include "perception/base/child_process.h"
#include "perception/base/parallel.h"
#include "perception/base/units.h"
#include "results/build_facts.h"

namespace results {

using nlohmann::ordered_json;

namespace {

std::string trimmed(std::string text) {
  constexpr const char* kBlanks = " \t\r\n\"";
  text.erase(0, text.find_first_not_of(kBlanks));
  const std::size_t last = text.find_last_not_of(kBlanks);
  text.erase(last == std::string::npos ? 0 : last + 1);
  return text;
}

std::optional<std::string> first_line(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) return std::nullopt;
  return trimmed(line);
}

/// The value of the first line that starts with the key, after the separator.
std::optional<std::string> value_of(const std::filesystem::path& path, const std::string& key,
                                    char separator) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t split = line.find(separator);
    if (split == std::string::npos || trimmed(line.substr(0, split)) != key) continue;
    return trimmed(line.substr(split + 1));
  }
  return std::nullopt;
}

std::string cpu_model() {
  return value_of("/proc/cpuinfo", "model name", ':').value_or("unknown CPU");
}

std::string host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "unknown-host";
  return name.data();
}

std::int64_t memory_bytes() {
  return static_cast<std::int64_t>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE);
}

std::string kernel() {
  utsname system{};
  uname(&system);
  return std::string(system.sysname) + " " + system.release + " " + system.machine;
}

std::optional<std::string> git(const std::vector<std::string>& arguments) {
  std::vector<std::string> command{"git", "-C", std::string(build_facts::kSourceFolder)};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const base::CommandResult result = base::run_command(command, std::chrono::seconds(10));
  if (result.timed_out || result.exit.code != 0 || result.exit.signal != 0) return std::nullopt;
  return trimmed(result.stdout_text);
}

void write_commit(ordered_json& json) {
  json["commit"] = nullptr;
  json["commit_dirty"] = nullptr;
  std::error_code missing;
  const std::filesystem::path source = build_facts::kSourceFolder;
  if (!std::filesystem::exists(source / ".git", missing)) return;
  const std::optional<std::string> commit = git({"rev-parse", "HEAD"});
  if (!commit) return;
  json["commit"] = *commit;
  const std::optional<std::string> changes = git({"status", "--porcelain", "--untracked-files=no"});
  if (changes) json["commit_dirty"] = !changes->empty();
}

/// Lower-case letters, digits and single dashes.
std::string slug(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!result.empty() && result.back() != '-') {
      result += '-';
    }
  }
  while (!result.empty() && result.back() == '-') result.pop_back();
  return result.empty() ? "unknown" : result;
}

}  // namespace

ordered_json run_environment() {
  ordered_json json;
  json["machine"] = machine_name();
  json["cpu"] = cpu_model();
  json["cores"] = base::core_count();
  json["memory_bytes"] = memory_bytes();
  json["os"] = value_of("/etc/os-release", "PRETTY_NAME", '=').value_or("unknown");
  json["kernel"] = kernel();
  json["version"] = build_facts::kVersion;
  json["compiler"] = build_facts::kCompiler;
  json["build_type"] = build_facts::kBuildType;
  write_commit(json);
  json["libraries"] = ordered_json::object();
  for (const auto& [name, version] : build_facts::kLibraries) {
    json["libraries"][std::string(name)] = version;
  }
  const auto governor = first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  json["governor"] = governor ? ordered_json(*governor) : ordered_json(nullptr);
  std::array<double, 3> load{};
  const bool has_load = getloadavg(load.data(), 3) == 3;
  for (double& average : load) average = std::round(100.0 * average) / 100.0;
  json["load_average"] = has_load ? ordered_json(load) : ordered_json(nullptr);
  json["started_utc"] = base::utc_now();
  return json;
}

std::string machine_name() { return slug(host_name() + "-" + cpu_model()); }

}  // namespace results

#include "suites/command_line/device_probe.h"

#include <cmath>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/child_process.h"
#include "perception/base/errors.h"
#include "perception/base/units.h"
#include "renderers/renderer_list.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/known_words.h"
#include "suites/command_line/verbs.h"

namespace suites::command_line {

using nlohmann::ordered_json;

namespace {

ordered_json facts_json(const renderers::DeviceFacts& facts) {
  ordered_json limits = ordered_json::object();
  for (const auto& [name, value] : facts.limits) {
    const bool is_whole = std::trunc(value) == value && std::abs(value) < 1e15;
    limits[name] = is_whole ? ordered_json(static_cast<std::int64_t>(value)) : ordered_json(value);
  }
  return {{"renderer", facts.renderer},  {"vendor", facts.vendor},
          {"version", facts.version},    {"software", facts.is_software},
          {"limits", std::move(limits)}, {"reason", nullptr}};
}

ordered_json no_facts_json(const std::string& reason) {
  return {{"renderer", nullptr}, {"vendor", nullptr}, {"version", nullptr},
          {"software", nullptr}, {"limits", nullptr}, {"reason", reason}};
}

/// The line that `probe-device` prints; a driver may have printed others before it.
ordered_json last_object_of(const std::string& text) {
  ordered_json found;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    ordered_json json = ordered_json::parse(line, nullptr, false);
    if (json.is_object() && json.contains("reason")) found = std::move(json);
  }
  return found;
}

ordered_json answer_of(const base::CommandResult& result, std::chrono::duration<double> limit) {
  if (result.timed_out) {
    return no_facts_json("no answer within " + base::format_duration(limit.count()));
  }
  ordered_json answer = last_object_of(result.stdout_text);
  const bool is_whole = result.exit.code == 0 && result.exit.signal == 0;
  if (is_whole && answer.is_object()) return answer;
  return no_facts_json("the probe ended with " + result.exit.text());
}

}  // namespace

std::vector<std::string> known_devices() {
  std::vector<std::string> known{"auto"};
  for (const std::string& platform : renderers::device_platforms()) known.push_back(platform);
  return known;
}

ordered_json probed_device(const std::string& platform, const std::filesystem::path& program,
                           std::chrono::duration<double> limit) {
  ordered_json entry{{"name", platform},
                     {"kind", "gl"},
                     {"cores", nullptr},
                     {"gl_platform", platform},
                     {"libraries", ordered_json::object()}};
  try {
    const std::vector<std::string> command{program.string(), "probe-device", platform};
    entry.update(answer_of(base::run_command(command, limit), limit));
  } catch (const base::DeviceError& error) {
    entry.update(no_facts_json(error.what()));
  }
  return entry;
}

int run_probe_device(const ProbeDeviceArguments& arguments, Console& console) {
  require_known(arguments.platform, renderers::device_platforms(), "discern probe-device",
                "platform");
  ordered_json answer;
  try {
    answer = facts_json(renderers::probe_device(arguments.platform));
  } catch (const base::DeviceError& error) {
    answer = no_facts_json(error.what());
  } catch (const renderers::UnsupportedError& error) {
    answer = no_facts_json(error.what());
  }
  const auto replace = ordered_json::error_handler_t::replace;
  console.out << answer.dump(-1, ' ', false, replace) << '\n';
  return kAsExpected;
}

}  // namespace suites::command_line

#include "suites/command_line/device_probe.h"

#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

using suites::command_line::probed_device;

/// Stands programs in for the one that probes.
class DeviceProbe : public ProgramTest {
 protected:
  nlohmann::ordered_json probe(const std::string& script, double limit_s = 20.0) const {
    const std::filesystem::path program = write_text("probe", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    return probed_device("osmesa", program, std::chrono::duration<double>(limit_s));
  }
  void expect_unusable(const nlohmann::ordered_json& entry, const std::string& reason) const {
    EXPECT_EQ(entry["reason"], reason);
    EXPECT_EQ(entry["gl_platform"], "osmesa");
    EXPECT_EQ(entry["renderer"], nullptr);
    EXPECT_EQ(entry["limits"], nullptr);
  }
};

TEST_F(DeviceProbe, TakesTheLineAmongWhatADriverPrints) {
  const auto entry = probe(
      "echo MESA: warning\n"
      R"(echo '{"renderer":"r","vendor":"v","version":"4.5","software":true,)"
      R"("limits":{"a":1},"reason":null}')"
      "\necho '{}'");
  EXPECT_EQ(entry["renderer"], "r");
  EXPECT_EQ(entry["limits"]["a"], 1);
  EXPECT_EQ(entry["kind"], "gl");
  EXPECT_EQ(entry["reason"], nullptr);
}

TEST_F(DeviceProbe, ACrashAHangAndAFailureAreReasons) {
  expect_unusable(probe("kill -SEGV $$"), "the probe ended with signal 11 (Segmentation fault)");
  expect_unusable(probe("exit 7"), "the probe ended with exit code 7");
  expect_unusable(probe("true"), "the probe ended with exit code 0");
  expect_unusable(probe("sleep 30", 0.2), "no answer within 200 ms");
  expect_unusable(probe(R"(echo '{"renderer":null,"limits":null,"reason":"no such driver"}')"),
                  "no such driver");
}

TEST_F(DeviceProbe, TheVerbPrintsOneLine) {
  for (const std::string platform : {"egl-device", "egl-surfaceless", "osmesa"}) {
    const auto result = discern({"probe-device", platform});
    EXPECT_EQ(result.exit.code, 0) << result.stderr_text;
    const auto json = nlohmann::json::parse(result.stdout_text, nullptr, false);
    ASSERT_TRUE(json.is_object()) << result.stdout_text;
    EXPECT_EQ(json["renderer"].is_null(), json["reason"].is_string());
  }
}

}  // namespace
}  // namespace tests

#include "results/run_environment.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/names.h"

namespace {

TEST(RunEnvironment, HasTheDocumentedKeys) {
  const nlohmann::ordered_json json = results::run_environment();
  const std::vector<std::string> expected{
      "machine",      "cpu",       "cores",    "memory_bytes", "os",
      "kernel",       "version",   "compiler", "build_type",   "commit",
      "commit_dirty", "libraries", "governor", "load_average", "started_utc"};
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_EQ(keys, expected);
}

TEST(RunEnvironment, FactsArePlausible) {
  const nlohmann::ordered_json json = results::run_environment();
  EXPECT_GE(json["cores"].get<int>(), 1);
  EXPECT_GT(json["memory_bytes"].get<std::int64_t>(), 1 << 26);
  EXPECT_FALSE(json["cpu"].get<std::string>().empty());
  EXPECT_EQ(json["started_utc"].get<std::string>().size(), 20U);
  EXPECT_EQ(json["kernel"].get<std::string>().rfind("Linux ", 0), 0U);
}

TEST(RunEnvironment, EveryLibraryHasAVersion) {
  const nlohmann::ordered_json libraries = results::run_environment()["libraries"];
  for (const char* name : {"OpenEXR", "OpenCV", "OpenColorIO", "OpenImageIO", "Embree", "TBB"}) {
    ASSERT_TRUE(libraries.contains(name)) << name;
  }
  for (const auto& [name, version] : libraries.items()) {
    const std::string text = version.get<std::string>();
    EXPECT_NE(text.find('.'), std::string::npos) << name << " " << text;
  }
}

TEST(RunEnvironment, MachineNameCanBeAFileName) {
  EXPECT_TRUE(base::is_path_safe(results::machine_name())) << results::machine_name();
  EXPECT_EQ(results::machine_name(), results::machine_name());
}

}  // namespace

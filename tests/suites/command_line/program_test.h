#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "perception/base/child_process.h"
#include "perception/image.h"

namespace tests {

/// Runs the built program in a fresh folder; its results go below it.
class ProgramTest : public testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  /// stdout, stderr and the exit code of `discern <words>`.
  base::CommandResult discern(const std::vector<std::string>& words) const;
  /// The JSON object of `discern <words> --json`, which must end with the exit code and print
  /// nothing else on stdout, and must follow the schema.
  nlohmann::ordered_json discern_json(std::vector<std::string> words, const std::string& schema,
                                      int exit_code = 0) const;

  /// Expects `discern <words>` to fail with the code and exactly this message on stderr.
  void expect_refused(const std::vector<std::string>& words, const std::string& message,
                      int exit_code = 2) const;

  /// What is wrong with JSON text (an object, or one per line) by a schema of the program; "" if
  /// nothing is.
  std::string schema_problems(const std::string& schema, const std::string& json) const;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write_text(const std::string& name, const std::string& text) const;
  /// Writes a constant scene-linear image as EXR.
  std::string write_image(const std::string& name, int width_px, int height_px, float value) const;
  std::string write_image(const std::string& name, const perception::Image& image) const;

  const std::filesystem::path& folder() const { return folder_; }
  std::vector<std::pair<std::string, std::string>> environment() const;

 private:
  std::filesystem::path folder_;
};

}  // namespace tests

#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "results/result_store.h"
#include "suites/suite_runner.h"
#include "tests/suites/test_suite.h"
#include "tests/temporary_folder.h"

namespace tests {

inline constexpr const char* kBlankAndPath =
    "methods: [{id: b, renderer: blank, parameters: {radiance: 0.25}}, {id: pt, renderer: path}]\n"
    "budgets: [{samples: 4}]\n"
    "measure: {seeds: 2, repetitions: {min: 2, max: 2}}\n"
    "metrics: [relmse, ssim]\n";

/// Runs small suites in a folder of its own.
class Runs : public testing::Test {
 protected:
  ~Runs() override { suites::interrupt_requested = false; }

  suites::Suite suite(const std::string& rest) {
    return suite_from(folder_.path(), kSuiteHead + rest);
  }
  suites::RunOptions options() { return run_options(folder_.path()); }
  suites::RunOutcome run(const std::string& rest) { return tests::run(suite(rest), options()); }

  /// One method of `blank` that behaves as named.
  static std::string blank(const std::string& behaviour, const std::string& measure) {
    return "methods: [{id: b, renderer: blank, parameters: {behaviour: \"" + behaviour +
           "\"}}]\nmeasure: {warmup: 0, " + measure + "}\n";
  }
  static std::vector<results::CellRecord> records_of(const suites::RunOutcome& outcome) {
    return results::load_run(outcome.run_folder).cells;
  }
  static std::string state_of(const suites::RunOutcome& outcome) {
    return results::load_run(outcome.run_folder).info->at("state").get<std::string>();
  }
  static std::size_t line_count(const std::filesystem::path& file) {
    const std::string text = base::read_text_file(file);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

  TemporaryFolder folder_;
};

}  // namespace tests

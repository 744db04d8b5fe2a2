#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "results/figures/figure_spec.h"
#include "results/result_store.h"

namespace test_figures {

/// A run in memory, cell by cell.
class SyntheticSuite {
 public:
  explicit SyntheticSuite(std::filesystem::path folder = "/nowhere/runs/suite/run");

  /// "room[light=2]" brings the sweep value with it.
  void add_scene(const std::string& id);
  void add_method(const std::string& id);
  void set_metrics(const std::vector<std::string>& metrics);

  struct Cell {
    std::string scene, method;
    std::string budget = "fixed";
    std::uint64_t seed = 1;
    int repetition = 0;
    int frame = 0;
    double total_s = 1.0;
    std::vector<std::pair<std::string, double>> scores{};  ///< of metrics against own
    std::optional<double> noise_floor{};
    std::vector<std::pair<std::string, std::vector<double>>> counters{};
    bool is_following = false;  ///< a following frame of a sequence
    std::string image{};
    std::string map{};  ///< of every score
  };
  void add(const Cell& cell);
  results::Run& run();

 private:
  results::Run run_;
  nlohmann::ordered_json info_;
};

/// Five methods with sweeps, budgets and seeds on two scenes, with images, maps and references in
/// <root>; looks like a real run.
results::Run realistic_run(const std::filesystem::path& root);
/// A sequence of 40 frames rendered by two methods.
results::Run realistic_sequence();

/// The figures of a suite's text: `- {id: a, kind: pareto, y: relmse}`.
std::vector<results::figures::FigureSpec> figures_of(const std::string& yaml);

}  // namespace test_figures

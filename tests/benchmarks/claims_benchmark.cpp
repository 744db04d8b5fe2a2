// Time to evaluate 100 claims on a run of 2,000 cells: 500 rows of 4 seeds with 5 repetitions each.

#include <benchmark/benchmark.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/claims/claim_result.h"
#include "tests/results/synthetic_run.h"

namespace {

using nlohmann::ordered_json;

constexpr int kScenes = 10;
constexpr int kMethods = 50;
constexpr int kSeeds = 4;
constexpr int kRepetitions = 5;

void add_scores(results::Run& run, const std::string& cell, int method, int seed) {
  for (const char* metric : {"relmse", "flip", "visible-difference"}) {
    for (const char* against : {"own", "full"}) {
      results::MetricRecord score = test_results::full_metric_record();
      score.cell = cell;
      score.metric = metric;
      score.against = against;
      score.value = 1.0 / (1.0 + method) + 0.001 * seed;
      run.metrics.push_back(std::move(score));
    }
  }
}

results::Run synthetic_run() {
  results::Run run;
  ordered_json info = {{"schema", 1}, {"profile", "half"}};
  for (int scene = 0; scene < kScenes; ++scene) {
    info["scenes"].push_back({{"id", fmt::format("scene-{}", scene)}, {"faces", 1000 * scene}});
  }
  for (int method = 0; method < kMethods; ++method) {
    info["methods"].push_back({{"id", fmt::format("val[vals={}]", method + 1)},
                               {"sweep", {{"vals", method + 1}}},
                               {"parameters", {{"vals", method + 1}, {"vpls", 1024}}},
                               {"renderer", "clustered-visibility"},
                               {"preset", "best"}});
  }
  info["metrics"] = {"relmse", "flip", "visible-difference"};
  for (int scene = 0; scene < kScenes; ++scene) {
    for (int method = 0; method < kMethods; ++method) {
      for (int seed = 1; seed <= kSeeds; ++seed) {
        for (int repetition = 0; repetition < kRepetitions; ++repetition) {
          results::CellRecord cell = test_results::timed_cell(
              fmt::format("scene-{}", scene), fmt::format("val[vals={}]", method + 1),
              static_cast<std::uint64_t>(seed), 0.1 + 0.01 * method + 0.001 * repetition);
          cell.repetition = repetition;
          if (repetition == 0) add_scores(run, cell.cell, method, seed);
          run.cells.push_back(std::move(cell));
        }
      }
    }
  }
  run.info = std::make_shared<ordered_json>(std::move(info));
  return run;
}

/// Claims of every kind; one in ten is of all 500 rows, the others of 1 to 50.
std::vector<results::claims::Claim> hundred_claims() {
  std::vector<results::claims::Claim> claims;
  for (int i = 0; i < 10; ++i) {
    const std::string scene = fmt::format("scene=scene-{}", i);
    const std::string one = fmt::format("val[vals={}, {}]", i + 1, scene);
    const std::pair<std::string, std::string> texts[] = {
        {fmt::format("share({}, gather)", one), "largest"},
        {fmt::format("value({}, total_s) / value(val[vals=30, {}], total_s)", one, scene), "<= 1"},
        {fmt::format("r2(val[{}], transport, vals * faces)", scene), ">= 0.95"},
        {fmt::format("series(val[vals<=10, {}], relmse, vals)", scene), "falls"},
        {fmt::format("series(val[{}], flip, vals)", scene), "decreasing"},
        {fmt::format("quantile(val[{}], total_s, 0.95)", scene), "<= 1"},
        {fmt::format("share_of(val[{}], links >= 2)", scene), ">= 0.5"},
        {fmt::format("smallest(val[{}], vals, visible-difference < 0.1)", scene), "<= 20"},
        {fmt::format("spearman(val[{}], relmse@full, total_s)", scene), "<= -0.9"},
        {fmt::format("median(*[vals>={}], total_s)", i), ">= 0.1"}};
    for (const auto& [measure, expect] : texts) {
      results::claims::Claim claim;
      claim.id = fmt::format("claim-{}", claims.size());
      claim.measures = {measure};
      claim.measure_places.resize(1);
      claim.expect = expect;
      claims.push_back(std::move(claim));
    }
  }
  return claims;
}

void evaluate_claims(benchmark::State& state) {
  const results::Run run = synthetic_run();
  const std::vector<results::claims::Claim> claims = hundred_claims();
  const results::RunValues values(run);
  for (auto _ : state) {
    const auto results = results::claims::evaluate(claims, values);
    benchmark::DoNotOptimize(results.data());
    state.SetLabel(results::claims::format_counts(results));
  }
}

void read_run_values(benchmark::State& state) {
  const results::Run run = synthetic_run();
  for (auto _ : state) {
    const results::RunValues values(run);
    benchmark::DoNotOptimize(values.rows().data());
  }
}

BENCHMARK(read_run_values)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(evaluate_claims)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();

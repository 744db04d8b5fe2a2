#include "tests/results/claims/claim_run.h"

#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/results/synthetic_run.h"

namespace test_results {

using nlohmann::ordered_json;
using results::CellRecord;

ClaimRun::ClaimRun() {
  auto info = std::make_shared<ordered_json>(ordered_json::object());
  info_ = info.get();
  run_.info = info;
  *info_ = {{"schema", 1},
            {"profile", "half"},
            {"scenes", ordered_json::array()},
            {"methods", ordered_json::array()},
            {"metrics", {"relmse", "flip", "mse"}},
            {"planned_cells", ordered_json::array()}};
}

std::string ClaimRun::Method::id() const {
  return sweep.empty() ? base : fmt::format("{}[{}={}]", base, sweep, x);
}

void ClaimRun::describe(const Method& method) {
  const auto has = [&](const char* list, const std::string& id) {
    for (const ordered_json& entry : (*info_)[list]) {
      if (entry.at("id") == id) return true;
    }
    return false;
  };
  if (!has("scenes", method.scene)) {
    (*info_)["scenes"].push_back({{"id", method.scene}, {"faces", 18}});
  }
  if (has("methods", method.id())) return;
  ordered_json sweep = ordered_json::object();
  if (!method.sweep.empty()) sweep[method.sweep] = method.x;
  ordered_json parameters = {{"max_depth", 8}};
  parameters.update(sweep);
  (*info_)["methods"].push_back({{"id", method.id()},
                                 {"sweep", sweep},
                                 {"parameters", parameters},
                                 {"renderer", "path"},
                                 {"preset", "best"}});
}

void ClaimRun::add_cell(const Method& method, std::uint64_t seed, int repetition, double total_s) {
  describe(method);
  CellRecord cell = timed_cell(method.scene, method.id(), seed, total_s);
  cell.repetition = repetition;
  cell.render.frame = 0;
  run_.cells.push_back(std::move(cell));
}

ClaimRun& ClaimRun::times(const Method& method, const std::vector<double>& totals_s) {
  int repetition = 0;
  for (const double total_s : totals_s) add_cell(method, 1, repetition++, total_s);
  return *this;
}

ClaimRun& ClaimRun::scores(const Method& method, const std::string& metric,
                           const std::vector<double>& values) {
  std::uint64_t seed = 1;
  for (const double value : values) {
    const std::string cell = timed_cell(method.scene, method.id(), seed, 1.0).cell;
    const bool is_new = std::none_of(run_.cells.begin(), run_.cells.end(),
                                     [&](const CellRecord& record) { return record.cell == cell; });
    if (is_new) add_cell(method, seed, 0, 1.0);
    results::MetricRecord score = full_metric_record();
    score.cell = cell;
    score.frame = 0;
    score.against = "own";
    score.metric = metric;
    score.value = value;
    score.details = {{"p95", 2.0 * value}};
    run_.metrics.push_back(std::move(score));
    ++seed;
  }
  return *this;
}

ClaimRun& ClaimRun::noise_floor(double floor) {
  for (results::MetricRecord& score : run_.metrics) score.noise_floor = floor;
  return *this;
}

ClaimRun& ClaimRun::change(const std::function<void(CellRecord&)>& what) {
  what(run_.cells.back());
  return *this;
}

ClaimRun& ClaimRun::each_record(const std::function<void(CellRecord&)>& what) {
  for (CellRecord& record : run_.cells) what(record);
  return *this;
}

ClaimRun& ClaimRun::environment(const nlohmann::ordered_json& facts) {
  (*info_)["environment"] = facts;
  return *this;
}

ClaimRun& ClaimRun::metric(const std::string& name) {
  (*info_)["metrics"].push_back(name);
  return *this;
}

ClaimRun& ClaimRun::claims(const std::vector<results::claims::Claim>& list) {
  (*info_)["claims"] = results::claims::to_json(list);
  return *this;
}

ClaimRun& ClaimRun::profile(const std::string& name) {
  (*info_)["profile"] = name;
  return *this;
}

ClaimRun& ClaimRun::planned(const Method& method) {
  describe(method);
  (*info_)["planned_cells"].push_back({{"cell", method.scene + "." + method.id() + ".planned"},
                                       {"scene", method.scene},
                                       {"method", method.id()},
                                       {"budget", "64spp"}});
  return *this;
}

results::claims::ClaimResult ClaimRun::judge(const std::vector<std::string>& measures,
                                             const std::string& expect) const {
  return results::claims::evaluate(claim_of(measures, expect), results::RunValues(run_));
}

double ClaimRun::value(const std::string& measure) const {
  const results::claims::ClaimResult result = judge({measure}, "printed");
  EXPECT_EQ(result.reason, result.value ? result.reason : "a value") << measure;
  return result.value.value_or(std::numeric_limits<double>::quiet_NaN());
}

results::claims::Claim claim_of(const std::vector<std::string>& measures,
                                const std::string& expect) {
  results::claims::Claim claim;
  claim.id = "c";
  claim.item = "Table 1";
  claim.says = "it is so";
  claim.measures = measures;
  claim.measure_places.resize(measures.size());
  claim.expect = expect;
  return claim;
}

}  // namespace test_results

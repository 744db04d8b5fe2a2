#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "results/claims/claim_result.h"
#include "results/result_store.h"
#include "results/run_values.h"

namespace test_results {

/// A run put together by hand; each method is one cell per seed with repetitions.
class ClaimRun {
 public:
  ClaimRun();

  /// A method "base[sweep=x]" of a scene, or "base" with an empty sweep.
  struct Method {
    std::string base;
    std::string sweep{};
    int x = 0;
    std::string scene = "box";
    std::string id() const;
  };

  /// Total times of the repetitions of seed 1; stages as those of `timed_cell`.
  ClaimRun& times(const Method& method, const std::vector<double>& totals_s);
  /// A score per seed, each with a cell of 1 s.
  ClaimRun& scores(const Method& method, const std::string& metric,
                   const std::vector<double>& values);
  /// That of every score that was added so far.
  ClaimRun& noise_floor(double floor);
  /// Changes the last record that was added.
  ClaimRun& change(const std::function<void(results::CellRecord&)>& what);
  ClaimRun& each_record(const std::function<void(results::CellRecord&)>& what);
  /// "environment" of run.json.
  ClaimRun& environment(const nlohmann::ordered_json& facts);
  /// One more metric of run.json.
  ClaimRun& metric(const std::string& name);
  /// "claims" of run.json.
  ClaimRun& claims(const std::vector<results::claims::Claim>& list);
  ClaimRun& profile(const std::string& name);
  /// A planned cell without a record.
  ClaimRun& planned(const Method& method);

  const results::Run& run() const { return run_; }
  /// A claim on this run. @param measures  one, or those of a list
  results::claims::ClaimResult judge(const std::vector<std::string>& measures,
                                     const std::string& expect) const;
  /// The value of a measure; NaN, with a test failure that has the reason, if there is none.
  double value(const std::string& measure) const;

 private:
  void describe(const Method& method);
  void add_cell(const Method& method, std::uint64_t seed, int repetition, double total_s);

  results::Run run_;
  nlohmann::ordered_json* info_;
};

/// A claim with everything but measure and expectation filled in.
results::claims::Claim claim_of(const std::vector<std::string>& measures,
                                const std::string& expect);

}  // namespace test_results

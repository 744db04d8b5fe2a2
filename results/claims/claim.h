#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "perception/base/document.h"

/// What a paper says, as a measurement on a run and what it is expected to be (README.md).
namespace results::claims {

/// Whether a claim can be judged on other hardware, other scenes and without the paper's films.
enum class Comparable {
  yes,
  share_only,  ///< its times are shown, a share, ratio or order of them is judged
  no           ///< the numbers are shown, nothing is judged
};

/// What becomes of a row whose score is at the noise of its reference (reference_noise.h).
enum class BelowNoise {
  counts,       ///< it counts as it is
  skip,         ///< it is left out
  inconclusive  ///< the claim has no value
};

/// One entry of `claims:`, as it is written.
struct Claim {
  std::string id;                     ///< can be a file name; unique in its suite
  std::string item;                   ///< "Table 2"
  std::string says;                   ///< what the paper says
  std::vector<std::string> measures;  ///< one expression, or several that are compared in order
  std::string expect;
  std::vector<std::string> profiles;  ///< those it counts for; empty: all
  Comparable comparable = Comparable::yes;
  std::string comparable_reason;  ///< of `no`
  BelowNoise below_noise = BelowNoise::counts;
  std::string printed;    ///< what the paper prints; shown beside
  std::string criterion;  ///< where the bound comes from, e.g. "ours"

  base::Place place;  ///< of the id; no line where it was not read from a suite
  std::vector<base::Place> measure_places;  ///< one per measure
  base::Place expect_place;

  /// "yes", "share only", "no: hardware time".
  std::string comparable_text() const;
  /// "counts", "skip", "inconclusive".
  std::string below_noise_text() const;
};

/// Reads the list `claims:` of a suite and its expressions.
/// @throws base::InputError with file:line:column for unknown keys, ids that are used twice, and
///   for the character of an expression that is wrong
std::vector<Claim> read_claims(const base::Node& list);

/// Fields as in a suite; those that are empty are left out.
nlohmann::ordered_json to_json(const Claim& claim);
nlohmann::ordered_json to_json(std::span<const Claim> claims);
/// "claims" of run.json. @throws base::InputError naming the claim and the field
std::vector<Claim> claims_from_json(const nlohmann::ordered_json& list);

}  // namespace results::claims

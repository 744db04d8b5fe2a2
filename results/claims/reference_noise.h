#pragma once

#include <cstddef>
#include <vector>

#include "results/claims/evaluation.h"

namespace results::claims {

/// A score is below the noise floor if at least this part of its error is noise of the reference:
/// then it says as much of the reference as of the method (ours).
inline constexpr double kMostNoiseShare = 0.5;

/// The rows of a call's selector that count, as the claim's `below_noise` wants them: without those
/// of which a score that the call looks at is below the noise floor. A row that is left out is
/// noted in the evaluation.
///
/// @throws base::InputError if none is left, or one is below and the claim has no value then
std::vector<std::size_t> counted_rows(const Expression& call, Evaluation& evaluation);
/// Likewise of rows that are selected already.
std::vector<std::size_t> counted_rows(const Expression& call, std::vector<std::size_t> rows,
                                      Evaluation& evaluation);

}  // namespace results::claims

#pragma once

#include <string>

#include "results/claims/claim_result.h"
#include "results/claims/evaluation.h"
#include "results/claims/expectation.h"

namespace results::claims {

struct Judgement {
  Verdict verdict = Verdict::inconclusive;
  std::string reason;  ///< "" if it is reproduced
};

/// Whether a value is what is expected: reproduced if the whole interval is, not reproduced if all
/// of it is not, else inconclusive; without an interval its value decides. Of a list every element,
/// or every pair, has to be.
/// @throws base::InputError if the expectation says nothing of such a value
Judgement judge(const Expectation& expectation, const Value& value);

/// The share of stages, then those of every stage beside them: of other top-level stages, and of
/// those that lie within the same stage as one of them.
/// @param share  a call of `share`
Value shares_beside(const Expression& share, Evaluation& evaluation);

/// What the interval of a number leaves out; "" for nothing.
std::string interval_note(const Number& number);

/// "0.953 [0.95, 0.96]".
std::string format_number(double value, const std::optional<Interval>& interval);

}  // namespace results::claims

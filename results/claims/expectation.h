#pragma once

#include <limits>
#include <string>
#include <string_view>

#include "perception/base/errors.h"

namespace results::claims {

/// What a claim's measure is to be.
struct Expectation {
  enum class Kind {
    bound,       ///< every value lies between two ends
    increasing,  ///< of a list: each value is greater than the one before
    decreasing,
    rises,  ///< of a list: Spearman's correlation with x is at least 0.9
    falls,
    largest,  ///< of a share: of all stages beside it; of a list: the first value of all
    smallest,
    printed  ///< nothing: the number is shown
  };
  Kind kind = Kind::bound;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool includes_low = true;
  bool includes_high = true;
  std::string text;

  /// Whether a value lies between the ends.
  bool includes(double value) const;
  bool is_below(double value) const;  ///< it lies under the low end
  bool is_above(double value) const;
};

/// `rises` and `falls` ask for a rank correlation of at least this size (ours).
inline constexpr double kTrendCorrelation = 0.9;
/// "= 16" holds up to this part of the number: sums and products of doubles differ by less (ours).
inline constexpr double kEqualityTolerance = 1e-9;

/// `>= 0.95`, `< 40%`, `= 34.1 within 5%`, `= 0.5 within 0.02`, `= 16`, `in 0.4..0.6`, or one of
/// the words. @throws base::InputError with the place of the character that is wrong
Expectation parse_expectation(std::string_view text, const base::Place& place);

}  // namespace results::claims

#pragma once

#include <cstddef>
#include <span>

#include "results/claims/evaluation.h"

/// What the functions over rows of function_table.cpp do; its texts say what each gives.
namespace results::claims {

Value value_of_row(const Expression& call, Evaluation& evaluation);
Value median_over_rows(const Expression& call, Evaluation& evaluation);
Value mean_over_rows(const Expression& call, Evaluation& evaluation);
Value min_over_rows(const Expression& call, Evaluation& evaluation);
Value max_over_rows(const Expression& call, Evaluation& evaluation);
Value sum_over_rows(const Expression& call, Evaluation& evaluation);
Value count_of_rows(const Expression& call, Evaluation& evaluation);
Value last_of_row(const Expression& call, Evaluation& evaluation);
Value quantile_of_samples(const Expression& call, Evaluation& evaluation);
Value share_of_samples(const Expression& call, Evaluation& evaluation);
Value share_of_time(const Expression& call, Evaluation& evaluation);
Value series_over(const Expression& call, Evaluation& evaluation);

Value argmin_over_rows(const Expression& call, Evaluation& evaluation);
Value argmax_over_rows(const Expression& call, Evaluation& evaluation);
Value smallest_that_meets(const Expression& call, Evaluation& evaluation);
Value least_at_error(const Expression& call, Evaluation& evaluation);
Value slope_over_rows(const Expression& call, Evaluation& evaluation);
Value loglog_slope_over_rows(const Expression& call, Evaluation& evaluation);
Value r2_over_rows(const Expression& call, Evaluation& evaluation);
Value spearman_over_rows(const Expression& call, Evaluation& evaluation);

Value score_at_time_of_row(const Expression& call, Evaluation& evaluation);
Value time_to_score_of_row(const Expression& call, Evaluation& evaluation);

/// The only row of a call's selector. @throws base::InputError if there are several
std::size_t single_row(const Expression& call, const Evaluation& evaluation);

/// The share of time that stages take of each of the rows, as the median over them.
/// @param lacks_none  a row without such a stage is an error; else the stage takes no time there
Number median_share(std::span<const std::size_t> rows, std::span<const Quantity> stages,
                    bool lacks_none, Evaluation& evaluation);

}  // namespace results::claims

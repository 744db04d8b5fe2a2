#pragma once

namespace results {

/// P(|T| <= t) for Student's t distribution: the finite series for whole degrees of freedom n, with
/// theta = atan(t / sqrt(n)).
///
/// @param t  >= 0  @param degrees_of_freedom  n, >= 1
/// Source: Abramowitz & Stegun, Handbook of Mathematical Functions, 1964, eqs. 26.7.3 (n odd) and
/// 26.7.4 (n even); equation numbers from memory, checked against printed quantiles.
double student_t_two_sided(double t, int degrees_of_freedom);

}  // namespace results

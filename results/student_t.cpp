#include "results/student_t.h"

#include <cmath>
#include <numbers>

namespace results {

double student_t_two_sided(double t, int n) {
  const double theta = std::atan(t / std::sqrt(static_cast<double>(n)));
  const double cosine = std::cos(theta);
  const double sine = std::sin(theta);
  const bool is_odd = n % 2 == 1;
  // Terms of the series: powers of cos^2 with the coefficients 2/3, 4/5, ... or 1/2, 3/4, ...
  double term = is_odd ? cosine : 1.0;
  double sum = n == 1 ? 0.0 : term;
  for (int k = is_odd ? 2 : 1; k <= n - 3; k += 2) {
    term *= cosine * cosine * static_cast<double>(k) / static_cast<double>(k + 1);
    sum += term;
  }
  return is_odd ? 2.0 / std::numbers::pi * (theta + sine * sum) : sine * sum;
}

}  // namespace results

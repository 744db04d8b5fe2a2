#include "metrics/separable_filter.h"

#include <gtest/gtest.h>

#include <vector>

namespace {

using metrics::Kernel;
using metrics::PaddedRow;
using metrics::Plane;

/// sum over k of weights[k] * values[clamp(i + k - radius)], the definition.
double filtered_at(const std::vector<double>& values, int i, const Kernel<double>& kernel) {
  double sum = 0.0;
  for (int k = 0; k < static_cast<int>(kernel.weights.size()); ++k) {
    const int position =
        std::clamp(i + k - kernel.radius(), 0, static_cast<int>(values.size()) - 1);
    sum += kernel.weights[static_cast<std::size_t>(k)] * values[static_cast<std::size_t>(position)];
  }
  return sum;
}

const Kernel<double> kLopsided{{0.1, -0.3, 0.5, 0.9, 2.0}};

std::vector<double> ramp(int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(i * i - 3.0 * i + 1.0);
  return values;
}

TEST(SeparableFilter, RowsFollowTheDefinitionAtEveryWidth) {
  for (const int width : {1, 2, 5, 15, 16, 17, 33, 50}) {
    const std::vector<double> values = ramp(width);
    PaddedRow<double> row(width, 4);
    std::copy(values.begin(), values.end(), row.data());
    row.repeat_ends();
    std::vector<double> out(values.size());
    row.filter(kLopsided, out.data());
    for (int x = 0; x < width; ++x) {
      EXPECT_DOUBLE_EQ(out[static_cast<std::size_t>(x)], filtered_at(values, x, kLopsided));
    }
  }
}

TEST(SeparableFilter, ColumnsFollowTheDefinitionAtEveryHeight) {
  for (const int height : {1, 2, 7, 30}) {
    const std::vector<double> values = ramp(height);
    Plane<double> plane(3, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < 3; ++x) plane.row(y)[x] = (x + 1) * values[static_cast<std::size_t>(y)];
    }
    for (int y = 0; y < height; ++y) {
      std::vector<double> out(3);
      metrics::filter_across_rows(plane, y, kLopsided, out.data());
      for (int x = 0; x < 3; ++x) {
        EXPECT_NEAR(out[static_cast<std::size_t>(x)], (x + 1) * filtered_at(values, y, kLopsided),
                    1e-9);
      }
    }
  }
}

TEST(PaddedRow, MirrorsAtTheCentresOfTheEnds) {
  metrics::PaddedRow<float> row(4, 2);
  for (int i = 0; i < 4; ++i) row.data()[i] = static_cast<float>(i);
  row.mirror_ends();
  const float expected[] = {2.0F, 1.0F, 0.0F, 1.0F, 2.0F, 3.0F, 2.0F, 1.0F};
  for (int i = -2; i < 6; ++i) EXPECT_EQ(row.data()[i], expected[i + 2]) << i;
}

}  // namespace

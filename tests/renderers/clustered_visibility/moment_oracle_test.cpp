#include "tests/renderers/clustered_visibility/moment_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace test_clustered_visibility {
namespace {

/// Random depths of random weights.
Kernel random_kernel(unsigned seed, int texels) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Kernel kernel;
  double sum = 0.0;
  for (int i = 0; i < texels; ++i) {
    kernel.push_back({uniform(random), 0.01 + uniform(random)});
    sum += kernel.back().weight;
  }
  for (KernelTexel& texel : kernel) texel.weight /= sum;
  return kernel;
}

TEST(MomentOracle, EvenSpreadGivesTheNodesOfGaussAndLegendre) {
  const Moments even{1.0, 0.0, 1.0 / 3.0, 0.0, 1.0 / 5.0};
  const MomentAtoms atoms = atoms_of(even, 0.0);
  EXPECT_NEAR(atoms.depth[0], -std::sqrt(0.6), 1e-15);
  EXPECT_NEAR(atoms.depth[1], std::sqrt(0.6), 1e-15);
  EXPECT_NEAR(atoms.mass[0], 5.0 / 18.0, 1e-15);
  EXPECT_NEAR(atoms.mass[1], 5.0 / 18.0, 1e-15);
  EXPECT_NEAR(atoms.mass[2], 8.0 / 18.0, 1e-15);
}

TEST(MomentOracle, AtomsHaveTheMomentsAndBoundTheMass) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Kernel kernel = random_kernel(seed, 3 + static_cast<int>(seed % 20));
    const Moments moments = moments_of(kernel);
    for (const double depth : {0.05, 0.3, 0.5, 0.77, 0.98}) {
      const MomentAtoms atoms = atoms_of(moments, 2.0 * depth - 1.0);
      double before = 0.0;
      for (const KernelTexel& texel : kernel) before += texel.z < depth ? texel.weight : 0.0;
      const double least = least_mass_before(atoms);
      EXPECT_LE(least, before + 1e-9) << seed << " " << depth;
      EXPECT_GE(least + atoms.mass[2], before - 1e-9) << seed << " " << depth;
      Moments own{};
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_GT(atoms.mass[i], -1e-9) << seed;
        for (std::size_t power = 0; power < own.size(); ++power) {
          own[power] += atoms.mass[i] * std::pow(atoms.depth[i], static_cast<double>(power));
        }
      }
      for (std::size_t power = 0; power < own.size(); ++power) {
        EXPECT_NEAR(own[power], moments[power], 1e-8) << seed << " " << power;
      }
    }
  }
}

}  // namespace
}  // namespace test_clustered_visibility

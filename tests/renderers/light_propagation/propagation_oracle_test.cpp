// Propagation against the same sums in double precision, cell by cell and face by face.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "renderers/light_propagation/intensity_lobe.h"
#include "renderers/light_propagation/propagation.h"

namespace renderers::light_propagation {
namespace {

constexpr double kPi = std::numbers::pi;
const double kFar_sr = 4.0 * std::atan(1.0 / (3.0 * std::sqrt(11.0)));
const double kSide_sr = (2.0 * kPi / 3.0 - kFar_sr) / 4.0;

/// A coefficient and its three channels, four times.
using Cells = std::vector<std::array<glm::dvec3, 4>>;

Cells doubles_of(const LightVolume& volume) {
  Cells cells(volume.cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t k = 0; k < 4; ++k) cells[i][k] = glm::dvec3(glm::vec3(volume.cells[i][k]));
  }
  return cells;
}

/// Intensity towards a direction, from Y00 = 1 / (2 sqrt(pi)) and Y1 = sqrt(3 / (4 pi)) d.
glm::dvec3 intensity_of(const std::array<glm::dvec3, 4>& cell, const glm::dvec3& direction) {
  const double y0 = 0.5 / std::sqrt(kPi);
  const double y1 = std::sqrt(0.75 / kPi);
  return y0 * cell[0] +
         y1 * (direction.x * cell[1] + direction.y * cell[2] + direction.z * cell[3]);
}

/// One step: intensity towards each face times its solid angle, sent on as a cosine lobe.
Cells step_of(const Grid& grid, const Cells& from, const BlockingVolume* blocking, bool has_clamp) {
  Cells to(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    for (int way = 0; way < 6; ++way) {
      glm::ivec3 along(0);
      along[way / 2] = way % 2 == 0 ? 1 : -1;
      const glm::ivec3 neighbour = grid.cell(i) - along;
      if (!grid.holds(neighbour)) continue;
      for (int face = 0; face < 6; ++face) {
        glm::ivec3 normal(0);
        normal[face / 2] = face % 2 == 0 ? 1 : -1;
        if (normal == -along) continue;  // the face that both share
        const glm::dvec3 direction = glm::normalize(glm::dvec3(along) + 0.5 * glm::dvec3(normal));
        glm::dvec3 sent = intensity_of(from[grid.index(neighbour)], direction) *
                          ((normal == along ? kFar_sr : kSide_sr) / kPi);
        if (has_clamp) sent = glm::max(sent, glm::dvec3(0.0));
        if (blocking != nullptr) {
          sent *= static_cast<double>(
              blocking->transmission(grid.cell(i), face / 2, face % 2 == 0, glm::vec3(direction)));
        }
        // A cosine lobe of flux pi: sqrt(pi) / 2 and sqrt(pi / 3).
        to[i][0] += std::sqrt(kPi) / 2.0 * sent;
        to[i][static_cast<std::size_t>(1 + face / 2)] +=
            std::sqrt(kPi / 3.0) * (face % 2 == 0 ? 1.0 : -1.0) * sent;
      }
    }
  }
  return to;
}

/// Greatest difference of a coefficient, by the greatest coefficient.
double difference(const LightVolume& volume, const Cells& truth) {
  double greatest = 0.0;
  double apart = 0.0;
  const Cells cells = doubles_of(volume);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (int c = 0; c < 3; ++c) {
        greatest = std::max(greatest, std::fabs(truth[i][k][c]));
        apart = std::max(apart, std::fabs(truth[i][k][c] - cells[i][k][c]));
      }
    }
  }
  return apart / greatest;
}

/// Sides that are no multiples of what the machine adds at once, light in some cells, surfaces in
/// others.
class PropagationOracle : public testing::Test {
 protected:
  PropagationOracle() {
    std::minstd_rand random(7);
    const auto number = [&] {  // -1 to 1
      return 2.0F * static_cast<float>(random()) / static_cast<float>(random.max()) - 1.0F;
    };
    const auto numbers = [&] {
      glm::vec3 three;
      for (int i = 0; i < 3; ++i) three[i] = number();
      return three;
    };
    for (CellLight& cell : light_.cells) {
      if (number() > 0.5F) continue;
      const glm::vec3 towards = glm::normalize(numbers());
      add_lobe(cell, cosine_lobe(towards), glm::vec3(2.0F, 1.5F, 1.0F));
    }
    for (int i = 0; i < 60; ++i) {
      const glm::vec3 place = 0.5F * (1.0F + numbers());
      blocking_.add(place * glm::vec3(grid_.size), glm::normalize(numbers()), 0.6F);
    }
  }

  /// Sum of all steps and what still travels, both ways; asserts that they agree.
  void expect_agreement(bool is_blocked, bool has_clamp, int steps) {
    const Propagation made =
        propagate(light_, is_blocked ? &blocking_ : nullptr, {steps, has_clamp});
    Cells last = doubles_of(light_);
    Cells sum = last;
    for (int i = 0; i < steps; ++i) {
      last = step_of(grid_, last, is_blocked && i > 0 ? &blocking_ : nullptr, has_clamp);
      for (std::size_t cell = 0; cell < sum.size(); ++cell) {
        for (std::size_t k = 0; k < 4; ++k) sum[cell][k] += last[cell][k];
      }
    }
    EXPECT_LT(difference(made.sum, sum), 2e-6) << is_blocked << has_clamp << steps;
    EXPECT_LT(difference(made.last, last), 2e-6) << is_blocked << has_clamp << steps;
  }

  Grid grid_{glm::ivec3(11, 5, 7), glm::vec3(0.0F), 1.0F};
  LightVolume light_{grid_};
  BlockingVolume blocking_{grid_};
};

TEST_F(PropagationOracle, AgreesInTheOpen) {
  expect_agreement(false, false, 1);
  expect_agreement(false, false, 12);
}

TEST_F(PropagationOracle, AgreesWithBlockersAndTheClamp) {
  expect_agreement(true, false, 2);
  expect_agreement(true, false, 12);
  expect_agreement(true, true, 12);
  expect_agreement(false, true, 12);
}

/// Blockers take light and the clamp makes some: the cases above differ.
TEST_F(PropagationOracle, BlockersAndTheClampChangeTheResult) {
  const Cells open = doubles_of(propagate(light_, nullptr, {12, false}).sum);
  EXPECT_GT(difference(propagate(light_, &blocking_, {12, false}).sum, open), 0.01);
  EXPECT_GT(difference(propagate(light_, nullptr, {12, true}).sum, open), 0.001);
}

}  // namespace
}  // namespace renderers::light_propagation

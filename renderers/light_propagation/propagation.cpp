#include "renderers/light_propagation/propagation.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/light_propagation/face_transfer.h"

namespace renderers::light_propagation {

namespace {

constexpr std::size_t kRowGrain = 8;
constexpr std::size_t kWays = 6;
constexpr std::size_t kChannels = 3;
constexpr std::size_t kCoefficients = 4;

/// One of the six ways that light comes from a neighbour into a cell: along an axis, with a sign,
/// through the cell's far face and the four at its sides.
struct Way {
  int axis = 0;
  float sign = 1.0F;  ///< of the direction that light takes

  explicit Way(std::size_t number)
      : axis(static_cast<int>(number / 2)), sign(number % 2 == 0 ? 1.0F : -1.0F) {}

  glm::ivec3 step() const {
    glm::ivec3 way(0);
    way[axis] = sign > 0.0F ? 1 : -1;
    return way;
  }
  /// The axes of the faces at the sides: 1, 2 have the first, 3, 4 the second.
  std::array<int, 2> sides() const { return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2}; }
};

/// A face of the receiving cell, and light's direction from the neighbour's centre to its own.
struct Face {
  int axis = 0;
  bool is_greater = true;
  glm::vec3 direction{0.0F};  ///< unit length
};

/// Face 0 is the far one; at the sides, the one that looks along the axis is before the other.
Face face_of(const Way& way, std::size_t number) {
  const glm::vec3 along(way.step());
  if (number == 0) return {way.axis, way.sign > 0.0F, along};
  const int axis = way.sides()[(number - 1) / 2];
  const bool is_greater = number % 2 == 1;
  glm::vec3 centre = 2.0F * along;
  centre[axis] += is_greater ? 1.0F : -1.0F;
  return {axis, is_greater, glm::normalize(centre)};
}

/// Intensities as rows along x, one per coefficient and channel, with a margin of dark cells.
class Rows {
 public:
  explicit Rows(const Grid& grid) : stride_(grid.size + 2) {
    plane_ = static_cast<std::size_t>(stride_.x) * static_cast<std::size_t>(stride_.y) *
             static_cast<std::size_t>(stride_.z);
    values_.resize(kChannels * kCoefficients * plane_, 0.0F);
  }
  /// The row's value at x = 0; y, z from -1 to one beyond the last. @param coefficient  0 to 3
  float* row(std::size_t channel, std::size_t coefficient, int y, int z) {
    return values_.data() + offset(channel, coefficient, y, z);
  }
  const float* row(std::size_t channel, std::size_t coefficient, int y, int z) const {
    return values_.data() + offset(channel, coefficient, y, z);
  }
  std::size_t bytes() const { return values_.size() * sizeof(float); }

 private:
  std::size_t offset(std::size_t channel, std::size_t coefficient, int y, int z) const {
    return (channel * kCoefficients + coefficient) * plane_ +
           (static_cast<std::size_t>(z + 1) * static_cast<std::size_t>(stride_.y) +
            static_cast<std::size_t>(y + 1)) *
               static_cast<std::size_t>(stride_.x) +
           1;
  }

  glm::ivec3 stride_;
  std::size_t plane_ = 0;
  std::vector<float> values_;
};

/// Calls a function with y, z of every row, in parallel.
template <class Use>
void for_each_row(const Grid& grid, const Use& use) {
  const auto width = static_cast<std::size_t>(grid.size.y);
  const std::size_t count = width * static_cast<std::size_t>(grid.size.z);
  base::parallel_for(count, kRowGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      use(static_cast<int>(i % width), static_cast<int>(i / width));
    }
  });
}

/// Shares of light that pass each face of each way into each cell, as rows along x.
class Shares {
 public:
  Shares(const Grid& grid, const BlockingVolume& blocking)
      : count_(grid.cell_count()), values_(kWays * kFacesOfWay * count_) {
    for (std::size_t number = 0; number < kWays * kFacesOfWay; ++number) {
      const Face face = face_of(Way(number / kFacesOfWay), number % kFacesOfWay);
      float* share = values_.data() + number * count_;
      for_each_row(grid, [&](int y, int z) {
        const glm::ivec3 first(0, y, z);
        blocking.transmissions(first, face.axis, face.is_greater, face.direction,
                               {share + grid.index(first), static_cast<std::size_t>(grid.size.x)});
      });
    }
  }
  /// Of all cells, as the grid numbers them.
  const float* of(std::size_t way, std::size_t face) const {
    return values_.data() + (way * kFacesOfWay + face) * count_;
  }
  std::size_t bytes() const { return values_.size() * sizeof(float); }

 private:
  std::size_t count_;
  std::vector<float> values_;
};

void add_row(const float* __restrict from, int count, float* __restrict sum) {
  for (int x = 0; x < count; ++x) sum[x] += from[x];
}

/// A step of propagation, row by row.
class Step {
 public:
  /// @param shares  null: all light passes
  Step(const Grid& grid, const Shares* shares, bool has_clamp)
      : grid_(grid),
        shares_(shares),
        least_(has_clamp ? 0.0F : -std::numeric_limits<float>::infinity()),
        all_(static_cast<std::size_t>(grid.size.x), 1.0F) {}

  /// What the cells of a row get from their neighbours; it is added to the sum, too.
  void gather(const Rows& from, int y, int z, Rows& to, Rows& sum) const {
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      for (std::size_t k = 0; k < kCoefficients; ++k) {
        std::fill_n(to.row(channel, k, y, z), grid_.size.x, 0.0F);
      }
      for (std::size_t way = 0; way < kWays; ++way) {
        add_way(row_of(way, channel, from, {0, y, z}, to), grid_.size.x);
      }
      for (std::size_t k = 0; k < kCoefficients; ++k) {
        add_row(to.row(channel, k, y, z), grid_.size.x, sum.row(channel, k, y, z));
      }
    }
  }

 private:
  WayRow row_of(std::size_t number, std::size_t channel, const Rows& from, const glm::ivec3& cell,
                Rows& to) const {
    const Way way(number);
    const glm::ivec3 neighbour = cell - way.step();
    const auto [side, second] = way.sides();
    const std::array<int, 4> coefficients{0, 1 + way.axis, 1 + side, 1 + second};
    WayRow row;
    row.sign = way.sign;
    row.least = least_;
    for (std::size_t k = 0; k < coefficients.size(); ++k) {
      const auto coefficient = static_cast<std::size_t>(coefficients[k]);
      row.from[k] = from.row(channel, coefficient, neighbour.y, neighbour.z) + neighbour.x;
      row.to[k] = to.row(channel, coefficient, cell.y, cell.z);
    }
    for (std::size_t face = 0; face < kFacesOfWay; ++face) {
      row.shares[face] =
          shares_ == nullptr ? all_.data() : shares_->of(number, face) + grid_.index(cell);
    }
    return row;
  }

  Grid grid_;
  const Shares* shares_;
  float least_;
  std::vector<float> all_;  ///< ones
};

Rows rows_of(const LightVolume& volume) {
  Rows rows(volume.grid);
  for_each_row(volume.grid, [&](int y, int z) {
    const CellLight* cells = &volume.cells[volume.grid.index({0, y, z})];
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      for (std::size_t k = 0; k < kCoefficients; ++k) {
        float* row = rows.row(channel, k, y, z);
        for (int x = 0; x < volume.grid.size.x; ++x)
          row[x] = cells[x][k][static_cast<int>(channel)];
      }
    }
  });
  return rows;
}

LightVolume volume_of(const Rows& rows, const Grid& grid) {
  LightVolume volume(grid);
  for_each_row(grid, [&](int y, int z) {
    CellLight* cells = &volume.cells[grid.index({0, y, z})];
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      for (std::size_t k = 0; k < kCoefficients; ++k) {
        const float* row = rows.row(channel, k, y, z);
        for (int x = 0; x < grid.size.x; ++x) cells[x][k][static_cast<int>(channel)] = row[x];
      }
    }
  });
  return volume;
}

}  // namespace

Propagation propagate(const LightVolume& injected, const BlockingVolume* blocking,
                      const PropagationSettings& settings) {
  const Grid& grid = injected.grid;
  std::optional<Shares> shares;
  if (blocking != nullptr) shares.emplace(grid, *blocking);
  Rows last = rows_of(injected);
  Rows sum = last;
  Rows next(grid);
  // The first step leaves the surfaces that sent the light.
  const Step first(grid, nullptr, settings.has_clamp);
  const Step later(grid, shares ? &*shares : nullptr, settings.has_clamp);
  for (int i = 0; i < settings.steps; ++i) {
    const Step& step = i == 0 ? first : later;
    for_each_row(grid, [&](int y, int z) { step.gather(last, y, z, next, sum); });
    std::swap(last, next);
  }
  const std::size_t work_bytes = 3 * sum.bytes() + (shares ? shares->bytes() : 0);
  return {volume_of(sum, grid), volume_of(last, grid), work_bytes};
}

}  // namespace renderers::light_propagation

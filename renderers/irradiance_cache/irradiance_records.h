#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "renderers/irradiance_cache/hemisphere_grid.h"

namespace renderers::irradiance_cache {

/// How a record's weight falls to the end of its reach.
enum class Weights {
  ward,       ///< 1 / e: ends abruptly
  continuous  ///< 1 / e - 1 / a: ends at 0
};

struct RecordSettings {
  float accuracy = 0.15F;  ///< a: greatest error e of a record that is used
  bool gradients = true;
  bool neighbour_clamp = true;  ///< radii of neighbours differ by their distance at most
  Weights weights = Weights::continuous;
};

/// Records in an octree, and irradiance between them.
///
/// The error of record i at a point is e = |P - P_i| / R_i + sqrt(1 - N . N_i).
/// Sources: Ward, Rubinstein, Clear 1988, Eqs. 4 and 5 and the octree of its Sec. "Storing"
/// (numbers recalled); Ward and Heckbert 1992, Eq. 4 (gradients in the sum); Krivanek et al. 2006,
/// "Making Radiance and Irradiance Caching Practical", EGSR (neighbour clamping); Tabellion and
/// Lamorlette 2004, doi:10.1145/1015706.1015748 (weights that end at 0).
class IrradianceRecords {
 public:
  /// @param least, greatest  corners of a box with all records
  IrradianceRecords(const RecordSettings& settings, const glm::vec3& least,
                    const glm::vec3& greatest);

  void insert(IrradianceRecord record);
  std::size_t size() const { return records_.size(); }
  const std::vector<IrradianceRecord>& records() const { return records_; }
  std::int64_t memory_bytes() const;

  /// Mean of the records in reach. @param stretch  >= 1, at most kMostStretch: on the accuracy
  /// @return nothing if none is
  std::optional<glm::vec3> irradiance(const glm::vec3& position, const glm::vec3& normal,
                                      float stretch = 1.0F) const;
  static constexpr float kMostStretch = 2.0F;

 private:
  struct Node {
    std::array<std::uint32_t, 8> children{};  ///< 0: none
    std::vector<std::uint32_t> records;
  };
  struct Cube {
    glm::vec3 middle{0.0F};
    float half_m = 0.0F;
    Cube child(int octant) const;
  };
  void insert_below(std::uint32_t node, const Cube& cube, std::uint32_t record, float reach_m);
  template <typename Visit>
  void visit_near(const glm::vec3& position, const Visit& visit) const;
  float error(const IrradianceRecord& record, const glm::vec3& position,
              const glm::vec3& normal) const;
  void clamp_radii(IrradianceRecord& record);

  RecordSettings settings_;
  Cube root_;
  std::vector<Node> nodes_;
  std::vector<IrradianceRecord> records_;
};

}  // namespace renderers::irradiance_cache

#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/element_hierarchy/radiosity_solver.h"

namespace renderers::final_gather {

/// Where the samples on a sender lie.
enum class Positions {
  random,  ///< independent, drawn once per sender (Sec. 4.4.1)
  r2       ///< Roberts' R2 sequence, shifted at random once per sender: prefixes well spread; ours
};

/// Sample `index` of a sender on the unit square. @param key  of the sender
/// Source: Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences" (web page,
/// recalled): steps 1 / g and 1 / g^2, g^3 = g + 1.
glm::vec2 sender_position(Positions positions, std::uint64_t key, std::uint32_t index);

struct SenderPointSettings {
  Positions positions = Positions::r2;
  /// A sample brings its leaf's radiosity, or what the sender sends, a mean.
  bool by_leaf = true;
  /// Samples on a cluster by the power of its sides, or by their area.
  bool by_power = true;
  std::uint64_t seed = 1;
};

/// A point on a sender and the radiosity that it brings if it stands for the sender's area, W/m2.
struct SenderPoint {
  element_hierarchy::SidePoint side;
  glm::vec3 radiosity{0.0F};
};

/// Points on senders.
///
/// Uniform by area. On clusters, by default, by power: a side with radiosity B_i is drawn with a
/// density proportional to B_i (luminance), not to its area alone, and so brings its radiosity
/// times B / B_i, B the mean over the cluster. Few samples find the lamp in a cluster that way, and
/// none is spent on what is dark. A form factor by such points is that of the light: the mean of
/// the kernel weighted by B_i / B. Source: importance sampling; ours, the paper is silent on points
/// in clusters.
///
/// The first points of the links' sources are found once, as all receivers share them (Scheel et
/// al. 2002, Sec. 4.4.1: positions "random once and then fixed").
class SenderPoints {
 public:
  /// @param solution  must live as long as this
  SenderPoints(const element_hierarchy::Solution& solution, const SenderPointSettings& settings);

  /// Sample `index` of a sender, the same for all receivers.
  SenderPoint fixed(std::uint32_t sender, std::uint32_t index) const;
  /// @param u  in [0, 1)^2
  SenderPoint at(std::uint32_t sender, const glm::vec2& u) const;
  /// The same with a place on it that is given.
  SenderPoint at(std::uint32_t sender, const element_hierarchy::SidePoint& side) const;
  /// Of the numbers of `fixed`.
  std::uint64_t key(std::uint32_t sender) const;

  /// W/m2, mean of the radiosities of `at` if all of the sender is seen.
  glm::vec3 mean_radiosity(std::uint32_t sender) const;

  const SenderPointSettings& settings() const { return settings_; }
  std::int64_t memory_bytes() const;

 private:
  bool is_by_power(std::uint32_t sender) const;
  void sum_powers();
  void keep_points();

  const element_hierarchy::Solution& solution_;
  SenderPointSettings settings_;
  std::vector<double> power_before_w_;  ///< luminance, of whole sides, size + 1; empty: by area
  std::uint32_t kept_per_sender_ = 0;
  std::vector<std::uint32_t> slots_;  ///< per element: among the senders that are kept
  std::vector<SenderPoint> kept_;     ///< [slot][index]
};

}  // namespace renderers::final_gather

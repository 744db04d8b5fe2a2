#pragma once

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/element_hierarchy/radiosity_solver.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::final_gather {

/// Where the samples on a sender lie.
enum class Positions {
  random,  ///< independent, drawn once per sender (Sec. 4.4.1)
  r2       ///< Roberts' R2 sequence, shifted at random once per sender: prefixes well spread; ours
};

/// Whether all pixels share them.
enum class Reuse {
  fixed,     ///< bias in place of noise (Sec. 4.4.1)
  per_pixel  ///< drawn anew for every camera ray
};

struct TransferSettings {
  Positions positions = Positions::r2;
  Reuse reuse = Reuse::fixed;
  /// Form factors of patches by Lambert's formula and near samples bounded, or by samples of
  /// A cos cos / (pi r^2) alone.
  bool is_exact = true;
  /// A sample brings its leaf's radiosity, or what the sender sends, a mean.
  bool by_leaf = true;
  std::uint64_t seed = 1;
};

/// Sample `index` of a sender on the unit square. @param key  of the sender
/// Source: Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences" (web page,
/// recalled): steps 1 / g and 1 / g^2, g^3 = g + 1.
glm::vec2 sender_position(Positions positions, std::uint64_t key, std::uint32_t index);

/// A point that receives light.
struct Receiver {
  ray_tracing::SurfacePoint point;
  glm::vec3 normal{0.0F};        ///< shading normal on the lit side, unit length
  std::uint64_t ray_number = 0;  ///< of the camera ray, for `Reuse::per_pixel`
};

/// What a sender does to a point.
struct Transfer {
  double form_factor = 0.0;    ///< unoccluded, with the receiver's cosine
  double visibility = 0.0;     ///< share of it that arrives; 0 if not asked for
  glm::vec3 irradiance{0.0F};  ///< W/m2, visibility included; 0 if not asked for
  double visibility_rays = 0.0;
  double form_factor_samples = 0.0;
};

/// Evaluates the transport from elements to points by samples on the elements.
///
/// The number of samples is real: floor(N) whole samples and one of weight N - floor(N), so that
/// the result is continuous in N.
/// Source: Scheel, Stamminger, Seidel 2002, "Grid Based Final Gather for Radiosity on Complex
/// Clustered Scenes", CGF 21(3), Sec. 4.4.1; weights of the last sample ours.
class SenderTransfer {
 public:
  /// @param solution  must live as long as this
  SenderTransfer(const element_hierarchy::Solution& solution, const TransferSettings& settings)
      : solution_(solution), settings_(settings) {}

  /// Form factor, visibility and irradiance. @param samples  > 0
  Transfer whole(const Receiver& receiver, std::uint32_t sender, double samples) const;
  /// The form factor alone, without rays. @param samples  > 0
  Transfer form_factor(const Receiver& receiver, std::uint32_t sender, double samples) const;

  /// W/m2, that a sample on a sender brings, by `TransferSettings::by_leaf`.
  glm::vec3 radiosity_at(const element_hierarchy::SidePoint& point, std::uint32_t sender) const;

  const element_hierarchy::Solution& solution() const { return solution_; }
  const TransferSettings& settings() const { return settings_; }

 private:
  struct Sums;
  void begin(const Receiver& receiver, std::uint32_t sender, double samples, Sums& sums) const;
  void add_sample(const Receiver& receiver, std::uint32_t sender, const glm::vec2& place,
                  Sums& sums) const;
  void trace(Sums& sums) const;
  Transfer finish(const Receiver& receiver, std::uint32_t sender, const Sums& sums) const;

  const element_hierarchy::Solution& solution_;
  TransferSettings settings_;
};

}  // namespace renderers::final_gather

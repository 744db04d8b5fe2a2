#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/element_hierarchy/radiosity_solver.h"
#include "renderers/final_gather/sender_points.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::final_gather {

class VisiblePart;

/// Whether all pixels share them.
enum class Reuse {
  fixed,     ///< bias in place of noise (Sec. 4.4.1)
  per_pixel  ///< drawn anew for every camera ray
};

struct TransferSettings {
  SenderPointSettings points;
  Reuse reuse = Reuse::fixed;
  /// Form factors of patches by Lambert's formula and near samples bounded, or by samples of
  /// A cos cos / (pi r^2) alone.
  bool is_exact = true;
};

/// A point that receives light.
struct Receiver {
  ray_tracing::SurfacePoint point;
  glm::vec3 normal{0.0F};        ///< shading normal on the lit side, unit length
  std::uint64_t ray_number = 0;  ///< of the camera ray, for `Reuse::per_pixel`
};

/// A sender and how many samples on it are asked for, > 0.
struct TransferRequest {
  std::uint32_t sender = 0;
  double samples = 1.0;
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
      : solution_(solution), settings_(settings), points_(solution, settings.points) {}

  /// Form factor, visibility and irradiance. @param samples  > 0
  Transfer whole(const Receiver& receiver, std::uint32_t sender, double samples) const;
  /// The same of several senders, whose rays share packets: most senders have one or two.
  std::vector<Transfer> whole(const Receiver& receiver,
                              std::span<const TransferRequest> requests) const;
  /// The form factor alone, without rays. @param samples  > 0
  Transfer form_factor(const Receiver& receiver, std::uint32_t sender, double samples) const;

  const SenderPoints& points() const { return points_; }
  const element_hierarchy::Solution& solution() const { return solution_; }
  const TransferSettings& settings() const { return settings_; }

 private:
  struct Sums;
  struct Packet;
  void begin(const Receiver& receiver, std::uint32_t sender, double samples, Sums& sums) const;
  /// @param packet  for their rays; nullptr: none
  void add_samples(const Receiver& receiver, const TransferRequest& request, Sums& sums,
                   Packet* packet) const;
  void add_sample(const Receiver& receiver, std::uint32_t sender, std::uint32_t index, Sums& sums,
                  Packet* packet) const;
  /// @param part  of a patch with exact form factors: what is above the horizon; else nullptr
  SenderPoint point_for(const Receiver& receiver, std::uint32_t sender, std::uint32_t index,
                        const VisiblePart* part) const;
  void trace(Packet& packet) const;
  Transfer finish(const Receiver& receiver, const TransferRequest& request, const Sums& sums) const;

  const element_hierarchy::Solution& solution_;
  TransferSettings settings_;
  SenderPoints points_;
};

}  // namespace renderers::final_gather

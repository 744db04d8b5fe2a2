#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderers/element_hierarchy/radiosity_solver.h"

namespace renderers::final_gather {

/// An element that lights a neighbourhood.
struct Sender {
  std::uint32_t element = 0;
  double irradiance = 0.0;           ///< I_s: unoccluded, luminance, W/m2; the largest of the links
  bool is_occluded = true;           ///< every link says that no ray got through
  double visibility = 0.0;           ///< mean over the links
  double least_visibility = 1.0;     ///< over the links and their receivers
  double greatest_visibility = 0.0;  ///< likewise
  int links = 1;                     ///< that were merged
  double from_source_m = 0.0;        ///< nearest occluder seen by links; 0: none
  double from_receiver_m = 0.0;      ///< nearest occluder seen by links; 0: none
};

/// The senders of all links that arrive at some leaves or at their ancestors, made disjoint: where
/// one is above another, it is replaced by its children along the way down, which share its
/// irradiance by the power they send. So every source counts once.
///
/// Source: Scheel et al. 2002, Sec. 4.3 (union of the links); disjointness is ours, the paper is
/// silent.
/// @param leaves  of the hierarchy, each once
/// @return in the order of elements
std::vector<Sender> collect_senders(const element_hierarchy::Solution& solution,
                                    std::span<const std::uint32_t> leaves);

}  // namespace renderers::final_gather

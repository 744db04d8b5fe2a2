#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace renderers::element_hierarchy {

/// A positive number in 16 bits: 800 steps per octave from 2^-40 to 2^41.9, error at most 0.05 %.
/// 0 and what is smaller is 0.
inline std::uint16_t log_coded(double value) {
  if (!(value > 0.0)) return 0;
  const double code = std::round((std::log2(value) + 40.0) * 800.0) + 1.0;
  return static_cast<std::uint16_t>(std::clamp(code, 0.0, 65535.0));
}
inline float from_log_code(std::uint16_t code) {
  return code == 0 ? 0.0F : std::exp2((static_cast<float>(code) - 1.0F) / 800.0F - 40.0F);
}

/// A share in [0, 1] in 16 bits.
inline std::uint16_t share_coded(double share) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * 65535.0));
}
inline float from_share_code(std::uint16_t code) { return static_cast<float>(code) / 65535.0F; }

enum LinkFlag : std::uint16_t {
  self_link = 1,       ///< a cluster's exchange with itself
  by_rays = 2,         ///< counted by rays from the receiver, its ends being too close for pairs
  fully_occluded = 4,  ///< no ray got through: no proof
  cannot_refine = 8    ///< both ends are as small as they may get
};

/// What carries light from a source to a receiver, which is known from the link's place in the
/// receiver's span.
struct Link {
  std::uint32_t source = 0;
  float form_factor = 0.0F;            ///< receiver to source, mean over the receiver, unoccluded
  std::uint16_t visibility = 0;        ///< share of it that gets through; share code
  std::uint16_t least_visibility = 0;  ///< over points of the receiver; share code
  std::uint16_t greatest_visibility = 0;
  std::uint16_t irradiance = 0;  ///< unoccluded, luminance, W/m2: I_s of Eq. 1; log code
  std::uint16_t occluder_from_source_m = 0;    ///< nearest seen; log code, 0: none
  std::uint16_t occluder_from_receiver_m = 0;  ///< nearest seen; log code, 0: none
  std::uint16_t flags = 0;
  std::uint16_t error = 0;  ///< of the form factor times visibility over the receiver; log code

  bool is(LinkFlag flag) const { return (flags & flag) != 0; }
  /// Form factor times visibility.
  float transfer() const { return form_factor * from_share_code(visibility); }
};
static_assert(sizeof(Link) == 24);

}  // namespace renderers::element_hierarchy

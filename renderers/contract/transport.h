#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace renderers {

/// Which light paths an image holds; growing sets (DESIGN section 3).
enum class Transport {
  direct,      ///< emission seen by the camera + light that meets one surface (its whole BRDF)
  one_bounce,  ///< direct + paths with exactly one diffuse interreflection
  diffuse,     ///< direct + any number of diffuse interreflections; glossy at the last surface only
  full         ///< everything
};

enum class Part { all, indirect };  ///< indirect = the set less `direct`

/// What a method says its image is an estimate of.
struct Claims {
  Transport transport = Transport::full;
  Part part = Part::all;
  /// 1/m2; bound of cos cos / d2 between the surface seen by the camera and the next one on the
  /// path. Virtual point lights bound this connection alone: the segments before it, towards the
  /// light, are sampled and not bounded.
  std::optional<double> geometry_clamp;

  friend bool operator==(const Claims&, const Claims&) = default;
};

std::string to_string(Transport transport);
std::string to_string(Part part);
/// @throws base::InputError listing the accepted names
Transport transport_from_text(std::string_view text);
Part part_from_text(std::string_view text);

}  // namespace renderers

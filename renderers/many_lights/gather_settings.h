#pragma once

#include <glm/vec3.hpp>

namespace renderers::many_lights {

/// How a picture's pixels share the virtual lights.
///
/// Pixel (x, y) belongs to class s = (y mod n) n + x mod n and reads the contiguous run
/// [s N / n^2, (s + 1) N / n^2) of the N lights; its sum is multiplied by n^2. (A stride instead of
/// a run would give a pixel a thin strip of a Halton set.) Source: Segovia et al. 2006,
/// "Non-interleaved Deferred Shading of Interleaved Sample Patterns",
/// doi:10.2312/EGGH/EGGH06/053-060.
struct GatherSettings {
  int interleave = 8;           ///< n; 1: every light at every pixel
  float geometry_clamp = 0.0F;  ///< b, 1/m2; 0: none
  bool with_glossy = false;     ///< also the radiance that the receivers' lobes reflect
  glm::vec3 camera_position{0.0F};
};

/// A pixel's run of lights.
struct LightRun {
  int first = 0;
  int count = 0;
};
inline LightRun light_run(int x_px, int y_px, int interleave, int light_count) {
  const int classes = interleave * interleave;
  const int index = (y_px % interleave) * interleave + x_px % interleave;
  const auto begin = [&](int i) {
    return static_cast<int>(static_cast<long long>(i) * light_count / classes);
  };
  return {begin(index), begin(index + 1) - begin(index)};
}

}  // namespace renderers::many_lights

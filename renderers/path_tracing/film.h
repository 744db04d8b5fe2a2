#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "perception/image.h"
#include "perception/image_file.h"
#include "renderers/path_tracing/path_integrator.h"

namespace renderers::path_tracing {

/// Independent randomisations a pixel's samples are dealt to, in turn. Samples of one randomisation
/// depend on each other, so a variance can only be told from the spread of their means.
inline constexpr std::uint32_t kRandomisations = 8;

/// Sums over the samples of every pixel, box filter of one pixel. Sums are doubles: a mean of 2^20
/// samples keeps all the digits of a float.
///
/// Pixels may be added to from several threads, each pixel from one at a time. All pixels hold the
/// same number of samples whenever a result is asked for.
class Film {
 public:
  Film(int width_px, int height_px);

  /// What a film of so many samples per pixel and the images made of it take at least, bytes.
  static std::uint64_t needed_bytes(int width_px, int height_px, std::int64_t samples);

  std::size_t pixel_count() const { return pixels_.size(); }
  /// Makes room for samples up to an index. Call it before `add`, from one thread.
  void reserve(std::int64_t samples);
  /// @param pixel  row-major index  @param sample_index  from 0, each pixel's in order
  void add(std::size_t pixel, std::int64_t sample_index, const PathSample& sample);

  /// Mean of direct + indirect. @param samples  per pixel so far, >= 1
  perception::Image radiance(std::int64_t samples) const;
  perception::Image direct(std::int64_t samples) const;
  perception::Image indirect(std::int64_t samples) const;
  /// Variance of the pixel's mean, per channel: between the means m_b of the B randomisations in
  /// use, sum n_b (m_b - m)^2 / ((B - 1) n). Unbiased if their sizes n_b are equal, or the samples
  /// independent. Sobol' points in unequal sizes give too large a value: 1.2 times at 11 samples
  /// (measured), next to nothing from 64 on. @param samples  >= 2
  perception::Image variance(std::int64_t samples) const;
  /// albedo, normal, depth: means over the samples, depth over those that met a surface.
  std::vector<perception::NamedImage> first_surface(std::int64_t samples) const;

 private:
  struct PixelSums {
    glm::dvec3 direct{0.0};
    glm::dvec3 indirect{0.0};
    glm::dvec3 albedo{0.0};
    glm::dvec3 normal{0.0};
    double depth_m = 0.0;
    std::uint64_t surfaces = 0;
  };
  template <typename Value>
  perception::Image rgb_image(const Value& value) const;

  int width_px_;
  int height_px_;
  std::vector<PixelSums> pixels_;
  std::vector<std::vector<glm::dvec3>> radiance_;  ///< [randomisation][pixel]
};

}  // namespace renderers::path_tracing

#pragma once

#include <cstdint>
#include <memory>

#include "renderers/opengl/gpu_scene.h"
#include "renderers/shadow_maps/hemisphere_maps.h"
#include "renderers/shadow_maps/triangle_spheres.h"

namespace renderers::shadow_maps {

struct HardMapSettings {
  /// Height of the centres above the origins, share of the diagonal of the scene's bounds.
  float near_share = kNearShare;
  /// An image of at most so many texels is drawn by the thread that found it, a larger one by a
  /// work group of its own.
  int direct_texels = 64;
  /// Pairs of triangle and map that may wait for a work group, 16 bytes each. What does not fit is
  /// drawn by the thread that found it: slower, the same distances.
  int queue_capacity = 1 << 18;
  /// Also counts work (some time on its own).
  bool counts_work = false;
};

/// Work of the last fill.
struct HardMapWork {
  std::int64_t pairs = 0;         ///< triangles x maps
  std::int64_t direct_pairs = 0;  ///< with images of few texels; counts_work only
  std::int64_t queued_pairs = 0;
  std::int64_t overflow_pairs = 0;  ///< that did not fit into the queue
  std::int64_t texels_tested = 0;   ///< counts_work only; modulo 2^32
};

/// Fills hemispherical maps with the exact distance along each texel's ray to the nearest triangle,
/// both sides, by compute shaders: per triangle and map, the texels in a bound of the triangle's
/// curved image intersect their rays with it, and the nearest distance stays.
class HardMaps {
 public:
  explicit HardMaps(std::shared_ptr<opengl::Context> context, const HardMapSettings& settings = {});

  /// Draws the triangles into layers [0, count), seen from origins [first, first + count), and
  /// clears the rest.
  /// @throws base::DeviceError if the device fails
  void fill(HemisphereMaps& maps, const opengl::GpuScene& scene, const MapOrigins& origins,
            int first, int count);

  /// Waits for the device.
  HardMapWork work() const;
  std::int64_t memory_bytes() const;

 private:
  opengl::Program& bound_program(const char* pass, const HemisphereMaps& maps,
                                 const opengl::GpuScene& scene, const MapOrigins& origins);

  std::shared_ptr<opengl::Context> context_;
  HardMapSettings settings_;
  TriangleSpheres spheres_;
  opengl::Buffer queue_;
  std::int64_t pairs_ = 0;
};

}  // namespace renderers::shadow_maps

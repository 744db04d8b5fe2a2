#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>

#include <glm/vec2.hpp>

#include "renderers/opengl/framebuffer.h"
#include "renderers/opengl/gpu_scene.h"
#include "renderers/shadow_maps/hemisphere_maps.h"
#include "renderers/shadow_maps/triangle_spheres.h"

namespace renderers::shadow_maps {

struct HemicubeMapSettings {
  float near_share = kNearShare;  ///< as in HardMapSettings
  /// Width of a face over that of a map. At 1 a pixel of a face spans half a texel's angle around
  /// the axis and all of it at the horizon.
  float face_scale = 1.0F;
  int layers_at_once = 16;  ///< layers whose faces are kept at a time, fewer in large scenes
};

/// Fills hemispherical maps by the ordinary rasteriser: five perspective faces per map (Cohen and
/// Greenberg 1985, "The Hemi-Cube", doi:10.1145/325334.325171, recalled) hold the triangles seen,
/// with which the texels' rays are met. Distances are exact along the texels' rays except at
/// silhouettes and around triangles smaller than a pixel of a face.
class HemicubeMaps {
 public:
  explicit HemicubeMaps(std::shared_ptr<opengl::Context> context,
                        const HemicubeMapSettings& settings = {});

  /// Draws the triangles into layers [0, count), seen from origins [first, first + count), and
  /// clears the rest.
  /// @throws UnsupportedError if the faces of one map are beyond the device's sizes, naming both;
  ///   base::DeviceError if the device fails
  void fill(HemisphereMaps& maps, const opengl::GpuScene& scene, const MapOrigins& origins,
            int first, int count);

  /// Draw calls that fill so many maps: one a face of each.
  static int draw_count(int maps);
  std::int64_t memory_bytes() const;

 private:
  struct Batch {
    const opengl::GpuScene& scene;
    const MapOrigins& origins;
    float near_m;
    int first_origin;
    int first_layer;
    int layers;
  };

  void reserve(const HemisphereMaps& maps, const opengl::GpuScene& scene);
  opengl::Program& bound_program(std::initializer_list<const char*> passes, const Batch& batch);
  void list_triangles(const Batch& batch);
  void draw_faces(const Batch& batch);
  void resample(const HemisphereMaps& maps, const Batch& batch);

  std::shared_ptr<opengl::Context> context_;
  HemicubeMapSettings settings_;
  TriangleSpheres spheres_;
  opengl::Buffer lists_;  ///< per face of a batch, room for every triangle
  opengl::Buffer draws_;
  opengl::Texture atlas_;
  opengl::Texture depth_;
  opengl::Framebuffer target_;
  int face_px_ = 0;
  int columns_ = 0;  ///< blocks of faces in a row of the atlas
  int layers_at_once_ = 0;
};

}  // namespace renderers::shadow_maps

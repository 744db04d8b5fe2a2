#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "renderers/contract/stage_timer.h"
#include "renderers/scene/scene.h"
#include "renderers/shadow_maps/hemisphere_maps.h"
#include "renderers/shadow_maps/scene_points.h"

namespace renderers::shadow_maps {

/// What a point covers in a map: a square of its disc's angular radius, at the distance of its
/// centre; or its disc, seen at its true slant.
enum class SplatShape { square, disc };

struct ImperfectMapSettings {
  float near_share = kNearShare;  ///< as in HardMapSettings
  int point_sets = 256;           ///< map i draws set i modulo this
  int points_per_map = 1024;
  SplatShape splat_shape = SplatShape::disc;
  /// Splat radius over that of discs which have the scene's area together; discs of 1 leave a third
  /// of the surface uncovered where points lie at random.
  float splat_scale = 1.5F;
  int max_splat_px = 64;     ///< greatest width of a splat
  int pull_push_levels = 3;  ///< holes up to 2^levels texels wide are filled; 0: none
  /// Points move with the triangles they were dealt to (DealtPoints) instead of being dealt anew.
  bool keeps_points = false;
};

/// Biases for maps drawn from points, whose distances are not those of the texels' rays. Chosen by
/// measurement like LookupBias's: on cornell-box, 64 px, 1024 points, 10 % of the lit receivers are
/// dark and 7 % of the shadowed ones lit; by irradiance 6 % and 5 % of the lit receivers'.
inline constexpr LookupBias kImperfectBias{.normal_offset = 1.0F, .depth = 1.0F};

/// Fills hemispherical maps from few points of the scene each, and closes the holes between them.
///
/// Source: Ritschel et al. 2008, "Imperfect Shadow Maps for Efficient Computation of Indirect
/// Illumination", doi:10.1145/1409060.1409082, recalled: points on the surfaces dealt to the maps,
/// splats that grow as the distance falls, pull-push over valid texels of like distance.
/// Differs from the paper: points are stratified, not random; splats may be discs.
class ImperfectMaps {
 public:
  explicit ImperfectMaps(std::shared_ptr<opengl::Context> context,
                         const ImperfectMapSettings& settings = {});

  /// Makes the points anew, or moves those of the first call since `restart`. Stages `points` and
  /// `upload` under whatever stage is open.
  /// @throws UnsupportedError if they do not fit into a storage block of the device, before any is
  ///   made; says how many do
  void load(const scene::Scene& scene, StageTimer& timer);

  /// Forgets kept points.
  void restart() { dealt_.reset(); }

  /// Points that the last `load` had no triangle for; 0 unless points are kept.
  std::size_t points_left_behind() const { return left_behind_; }

  /// Draws layers [0, count), seen from origins [first, first + count), and clears the rest.
  /// @throws base::DeviceError if the device fails
  void fill(HemisphereMaps& maps, const MapOrigins& origins, int first, int count);

  std::int64_t memory_bytes() const;

 private:
  void require_room() const;
  void fill_holes(HemisphereMaps& maps, int count);
  std::vector<ScenePoint> points_of(const scene::Scene& scene);

  std::shared_ptr<opengl::Context> context_;
  ImperfectMapSettings settings_;
  opengl::Buffer points_;
  opengl::Texture coarse_;            ///< pulled levels, each half as wide as the one before
  std::optional<DealtPoints> dealt_;  ///< kept
  std::size_t left_behind_ = 0;
  bool has_points_ = false;
  float near_m_ = 0.0F;
};

}  // namespace renderers::shadow_maps

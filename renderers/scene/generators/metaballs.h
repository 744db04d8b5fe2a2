#pragma once

#include "renderers/scene/generators/generator_list.h"
#include "renderers/scene/mesh_sequence.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace renderers::scene {

struct MetaballSettings {
  std::uint64_t seed = 1;
  int balls = 8;
  int resolution = 32;     ///< cubes along the longest side
  glm::vec3 size_m{1.0F};  ///< the balls stay in this box around the origin
  float least_radius_m = 0.1F;
  float greatest_radius_m = 0.2F;
  int frames = 1;  ///< after these the movement would begin again
};

/// Balls that flow into each other and move: new triangles every frame.
///
/// The field is the sum of (1 - r^2 / R^2)^3 within R of each centre, the surface is where it is
/// 1/2 (after Wyvill, McPheeters, Wyvill 1986, "Data Structure for Soft Objects",
/// doi:10.1007/BF01900346, with a simpler polynomial); R is such that a ball alone has its radius.
/// Centres move on closed Lissajous curves within the box.
class Metaballs : public MeshSequence {
 public:
  explicit Metaballs(const MetaballSettings& settings);
  /// Smooth normals from the field's gradient.
  Mesh at_frame(int frame) const override;
  int last_frame() const override { return settings_.frames - 1; }

  /// A ball at a frame: centre and radius, metres.
  struct Ball {
    glm::vec3 center{0.0F};
    float radius_m = 0.0F;
  };
  std::vector<Ball> balls_at(int frame) const;

 private:
  struct Path {
    glm::vec3 middle{0.0F};
    glm::vec3 reach{0.0F};
    glm::vec3 turns{1.0F};  ///< whole numbers, in all frames
    glm::vec3 phase{0.0F};  ///< of a turn
    float radius_m = 0.0F;
  };

  MetaballSettings settings_;
  std::vector<Path> paths_;
};

/// {seed: 1, balls, resolution: 32, size: [x, y, z], radius: [least, greatest], frames: 1}.
std::vector<GeneratedPart> metaballs(base::MapReader& reader);

}  // namespace renderers::scene

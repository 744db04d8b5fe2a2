#pragma once

#include "renderers/scene/generators/atrium_building.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>

/// Measures of the atrium, and how its sides are placed.
namespace renderers::scene {

// Plan, metres. A side of the court is described along its x axis, with z outwards.
inline constexpr float kBay_m = 3.6F;          // from column to column
inline constexpr float kHalfWidth_m = 3.6F;    // of the court, to the columns' axes, along x
inline constexpr float kHalfLength_m = 10.8F;  // the same along z
inline constexpr float kHalfWall_m = 0.3F;     // half the arcade wall's thickness
inline constexpr float kAisle_m = 3.2F;        // from the arcade wall to the outer wall
inline constexpr float kOuter_m =
    kHalfWall_m + kAisle_m;              // from the columns' axes to the outer wall
inline constexpr float kPier_m = 0.45F;  // half the width of a corner pier

// Heights, metres.
inline constexpr float kSpringing_m = 3.2F;
inline constexpr float kGallery_m = 5.4F;
inline constexpr float kUpperColumn_m = 2.6F;
inline constexpr float kRoof_m = 10.4F;
inline constexpr float kHalfSpan_m = 1.4F;

/// One of the four sides of the court.
struct Side {
  glm::mat4 to_world;
  float half_length_m;  ///< to the corner piers' axes
  float distance_m;     ///< of the columns' axes from the court's centre
  int bays;
};

/// Rotation about y by whole quarter turns, without rounding: z turns towards x.
inline glm::mat4 quarter_turns(int turns) {
  constexpr std::array<float, 4> kCosines{1.0F, 0.0F, -1.0F, 0.0F};
  constexpr std::array<float, 4> kSines{0.0F, 1.0F, 0.0F, -1.0F};
  const float c = kCosines[static_cast<std::size_t>(turns)];
  const float s = kSines[static_cast<std::size_t>(turns)];
  return {
      {c, 0.0F, -s, 0.0F}, {0.0F, 1.0F, 0.0F, 0.0F}, {s, 0.0F, c, 0.0F}, {0.0F, 0.0F, 0.0F, 1.0F}};
}

inline glm::mat4 moved(float x, float y, float z) {
  return glm::translate(glm::mat4(1.0F), glm::vec3(x, y, z));
}

/// A number of points scaled by the level of detail, `least` at least.
inline int scaled(const AtriumDetail& detail, int count, int least) {
  return std::max(least, static_cast<int>(std::lround(static_cast<float>(count) * detail.level)));
}

/// Arcades, gallery, vaults, outer wall's pilasters and cloths of one side.
void add_side(AtriumParts& parts, const Side& side, const AtriumDetail& detail,
              std::mt19937_64& engine);

}  // namespace renderers::scene

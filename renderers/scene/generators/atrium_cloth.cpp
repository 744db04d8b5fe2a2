#include "renderers/scene/generators/atrium_pieces.h"

#include <cmath>
#include <numbers>

namespace renderers::scene {

TriangleSoup hanging_cloth(const ClothShape& shape) {
  constexpr float kTwoPi = 2.0F * std::numbers::pi_v<float>;
  const auto point = [&](int i, int j) {
    const float s = static_cast<float>(i) / static_cast<float>(shape.columns);
    const float t = static_cast<float>(j) / static_cast<float>(shape.rows);
    const float hang = 1.0F - t;  // 0 at the rod
    // Folds deepen and wander on the way down; the hem swings a little.
    const float fold = std::sin(kTwoPi * (shape.folds * s + shape.phase + 0.25F * hang * hang));
    const float second = std::sin(kTwoPi * (1.7F * shape.folds * s - 0.6F * hang + shape.phase));
    const float depth = shape.fold_depth_m * (0.35F + 0.65F * std::sqrt(hang));
    const float drawn_in = 1.0F - 0.10F * std::sin(0.5F * kTwoPi * hang);
    const float x = shape.width_m * (s - 0.5F) * drawn_in + 0.15F * shape.fold_depth_m * second;
    const float hem = 0.05F * hang * std::cos(kTwoPi * (shape.folds * s + shape.phase));
    const float y = shape.bottom_m + (shape.top_m - shape.bottom_m) * t + hem;
    const float z = depth * (0.8F * fold + 0.2F * second * hang);
    return Corner{{-x, y, z}, {s, t}};
  };
  TriangleSoup soup;
  soup.add_grid(shape.columns, shape.rows, point);
  return soup;
}

}  // namespace renderers::scene

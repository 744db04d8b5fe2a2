#pragma once

#include "renderers/scene/generators/triangle_soup.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <random>
#include <vector>

/// Pieces of architecture, in their own coordinates: metres, y up.
namespace renderers::scene {

/// Outline of a turned body: (radius, height), from bottom to top, front outside.
using Profile = std::vector<glm::vec2>;

/// Points of `profile` and `between` points on each of its pieces, on a Catmull-Rom curve.
Profile smoothed(const Profile& profile, int between);

/// Body of revolution about the y axis, open at both ends.
void add_lathe(TriangleSoup& soup, const Profile& profile, int around);

/// Round column on y = 0: square plinth, torus base, fluted shaft, capital, abacus.
struct ColumnShape {
  float height_m = 3.2F;
  float radius_m = 0.28F;      ///< of the shaft's foot
  float plinth_half_m = 0.4F;  ///< of the plinth and the abacus
  int flutes = 20;
  int around_flute = 3;  ///< points per flute
  int rings = 6;         ///< of the shaft
  int around = 24;       ///< of base and capital
  int smoothing = 2;     ///< points between those of the mouldings' profiles
};
TriangleSoup column(const ColumnShape& shape);

/// Wall with a round or elliptic opening, from the springing line up; along x, thick along z.
struct ArchShape {
  float half_width_m = 1.8F;  ///< of the wall; the opening's half span at least
  float half_span_m = 1.4F;
  float rise_m = 1.4F;
  float springing_m = 3.2F;
  float top_m = 5.4F;
  float least_z_m = -0.3F;
  float greatest_z_m = 0.3F;
  int segments = 16;
};
/// Without top and ends.
TriangleSoup arch_panel(const ArchShape& shape);

/// Wedge stones around the opening of a round arch, alternately thicker, with open joints.
/// @param stones  odd, so that there is a keystone
TriangleSoup voussoirs(const ArchShape& shape, int stones, int segments);

/// Groin vault over a rectangle around the origin, seen from below: two elliptic barrels of the
/// same rise that cross.
/// @param segments  of a quarter web
TriangleSoup groin_vault(const glm::vec2& half_size_m, float springing_m, float rise_m,
                         int segments);

/// Hanging cloth in the plane z = 0 with folds that grow from its top edge, x from -width / 2 to
/// width / 2, front along -z; uv runs over it once.
struct ClothShape {
  float width_m = 2.0F;
  float top_m = 3.0F;
  float bottom_m = 1.0F;
  float fold_depth_m = 0.12F;
  float folds = 5.0F;
  float phase = 0.0F;  ///< periods
  int columns = 24;
  int rows = 32;
};
TriangleSoup hanging_cloth(const ClothShape& shape);

/// Vase with a foot, standing on y = 0, its inside included.
TriangleSoup vase(float height_m, int around, int smoothing);

/// Leaves that grow from the origin and bend outwards.
TriangleSoup plant(std::mt19937_64& engine, int leaves, int segments);

}  // namespace renderers::scene

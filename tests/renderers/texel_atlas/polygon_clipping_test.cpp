#include "renderers/texel_atlas/polygon_clipping.h"

#include <gtest/gtest.h>

namespace renderers::texel_atlas {
namespace {

constexpr std::array<glm::dvec2, 3> kTriangle{glm::dvec2(0.3, 0.2), glm::dvec2(5.1, 1.4),
                                              glm::dvec2(1.9, 4.7)};

double area_of_triangle(const std::array<glm::dvec2, 3>& t) {
  const glm::dvec2 u = t[1] - t[0];
  const glm::dvec2 v = t[2] - t[0];
  return 0.5 * std::abs(u.x * v.y - u.y * v.x);
}

TEST(PolygonClipping, KeepsATriangleInsideAndNothingOutside) {
  const Piece whole = measure(clip_to_rectangle(kTriangle, {0, 0}, {6, 6}));
  EXPECT_NEAR(whole.area, area_of_triangle(kTriangle), 1e-12);
  EXPECT_NEAR(whole.centroid.x, (0.3 + 5.1 + 1.9) / 3.0, 1e-12);
  EXPECT_NEAR(whole.centroid.y, (0.2 + 1.4 + 4.7) / 3.0, 1e-12);
  EXPECT_EQ(measure(clip_to_rectangle(kTriangle, {6, 6}, {7, 7})).area, 0.0);
}

TEST(PolygonClipping, GivesTheClosedFormOfACutCorner) {
  // x + y < 1.5 over the unit square: all but the triangle beyond it, of sides 0.5.
  const std::array<glm::dvec2, 3> t{glm::dvec2(0, 0), glm::dvec2(1.5, 0), glm::dvec2(0, 1.5)};
  const Piece piece = measure(clip_to_rectangle(t, {0, 0}, {1, 1}));
  EXPECT_NEAR(piece.area, 0.875, 1e-12);
  // (1 * 0.5 - 0.125 * (1 - 0.5 / 3)) / 0.875
  EXPECT_NEAR(piece.centroid.x, (0.5 - 0.125 * (1.0 - 0.5 / 3.0)) / 0.875, 1e-12);
  EXPECT_NEAR(piece.centroid.y, piece.centroid.x, 1e-12);
}

TEST(PolygonClipping, CellsShareOutTheAreaInEitherWinding) {
  for (const bool is_turned : {false, true}) {
    auto t = kTriangle;
    if (is_turned) std::swap(t[1], t[2]);
    double area = 0.0;
    glm::dvec2 moment(0.0);
    for (int y = 0; y < 6; ++y) {
      for (int x = 0; x < 6; ++x) {
        const Piece piece = measure(clip_to_rectangle(t, {x, y}, {x + 1, y + 1}));
        area += piece.area;
        moment += piece.area * piece.centroid;
        if (piece.area <= 0.0) continue;
        EXPECT_GE(piece.centroid.x, x);
        EXPECT_LE(piece.centroid.x, x + 1);
        EXPECT_GE(piece.centroid.y, y);
        EXPECT_LE(piece.centroid.y, y + 1);
      }
    }
    EXPECT_NEAR(area, area_of_triangle(t), 1e-12);
    EXPECT_NEAR(moment.x / area, (0.3 + 5.1 + 1.9) / 3.0, 1e-12);
  }
}

}  // namespace
}  // namespace renderers::texel_atlas

#include "renderers/scene/generators/atrium_pieces.h"
#include "renderers/scene/generators/uniform_number.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace renderers::scene {
namespace {

constexpr float kTwoPi = 2.0F * std::numbers::pi_v<float>;

/// Angle of point i of n around the y axis; point n is point 0.
float angle_of(int i, int n) { return kTwoPi * static_cast<float>(i % n) / static_cast<float>(n); }

glm::vec3 around_axis(float radius_m, float height_m, float angle_rad) {
  return {radius_m * std::sin(angle_rad), height_m, radius_m * std::cos(angle_rad)};
}

/// Catmull and Rom 1974, uniform knots, tension 1/2.
glm::vec2 catmull_rom(const Profile& points, std::size_t i, float t) {
  const glm::vec2 b = points[i];
  const glm::vec2 c = points[i + 1];
  const glm::vec2 a = i == 0 ? b : points[i - 1];
  const glm::vec2 d = i + 2 == points.size() ? c : points[i + 2];
  return 0.5F * (2.0F * b + (c - a) * t + (2.0F * a - 5.0F * b + 4.0F * c - d) * t * t +
                 (3.0F * b - a - 3.0F * c + d) * t * t * t);
}

void add_block(TriangleSoup& soup, float half_m, float bottom_m, float top_m, unsigned open) {
  soup.add_box({-half_m, bottom_m, -half_m}, {half_m, top_m, half_m}, open);
}

/// Shaft with entasis (narrower towards the top) and round flutes cut into it.
void add_shaft(TriangleSoup& soup, const ColumnShape& shape, float bottom_m, float top_m) {
  constexpr float kTopRatio = 0.84F;    // radius at the top over that of the foot
  constexpr float kFluteDepth = 0.09F;  // of the radius
  const int around = shape.flutes * shape.around_flute;
  const auto point = [&](int i, int j) {
    const float t = static_cast<float>(j) / static_cast<float>(shape.rings);
    const float taper = 1.0F - (1.0F - kTopRatio) * t * t;
    const float in_flute =
        static_cast<float>(i % shape.around_flute) / static_cast<float>(shape.around_flute);
    const float depth = kFluteDepth * std::sin(0.5F * kTwoPi * in_flute);
    const float angle = angle_of(i, around);
    const float height_m = bottom_m + (top_m - bottom_m) * t;
    return Corner{
        around_axis(shape.radius_m * taper * (1.0F - depth), height_m, angle),
        {static_cast<float>(i) / static_cast<float>(around), height_m / kTexturePeriod_m}};
  };
  soup.add_grid(around, shape.rings, point);
}

}  // namespace

Profile smoothed(const Profile& profile, int between) {
  Profile result;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    for (int k = 0; k <= between; ++k) {
      result.push_back(
          catmull_rom(profile, i, static_cast<float>(k) / static_cast<float>(between + 1)));
    }
  }
  result.push_back(profile.back());
  return result;
}

void add_lathe(TriangleSoup& soup, const Profile& profile, int around) {
  const auto point = [&](int i, int j) {
    const glm::vec2& p = profile[static_cast<std::size_t>(j)];
    return Corner{around_axis(p.x, p.y, angle_of(i, around)),
                  {static_cast<float>(i) / static_cast<float>(around), p.y / kTexturePeriod_m}};
  };
  soup.add_grid(around, static_cast<int>(profile.size()) - 1, point);
}

TriangleSoup column(const ColumnShape& shape) {
  const float r = shape.radius_m;
  const float h = shape.height_m;
  const float plinth_top = 0.18F;
  const float base_top = plinth_top + 0.9F * r;
  const float capital_bottom = h - 0.14F - 1.9F * r;
  const float abacus_bottom = h - 0.14F;
  TriangleSoup soup;
  add_block(soup, shape.plinth_half_m, 0.0F, plinth_top, kLeastY);
  // Attic base: torus, scotia, torus.
  const Profile base{{0.98F, 0.0F},  {1.30F, 0.02F}, {1.38F, 0.16F}, {1.30F, 0.30F},
                     {1.16F, 0.34F}, {1.10F, 0.46F}, {1.14F, 0.56F}, {1.22F, 0.62F},
                     {1.22F, 0.74F}, {1.10F, 0.80F}, {0.99F, 0.90F}, {0.86F, 0.91F}};
  Profile placed;
  for (const glm::vec2& p : base) placed.emplace_back(p.x * r, plinth_top + p.y * r);
  add_lathe(soup, smoothed(placed, shape.smoothing), shape.around);
  add_shaft(soup, shape, base_top, capital_bottom);
  // Necking ring, then a bell that opens to the abacus.
  const Profile bell{{0.66F, -0.01F}, {0.80F, 0.0F},  {0.95F, 0.05F}, {0.98F, 0.14F},
                     {0.90F, 0.22F},  {0.84F, 0.30F}, {0.86F, 0.70F}, {0.96F, 1.10F},
                     {1.16F, 1.45F},  {1.30F, 1.66F}, {1.28F, 1.80F}, {1.14F, 1.90F}};
  placed.clear();
  for (const glm::vec2& p : bell) placed.emplace_back(p.x * r, capital_bottom + p.y * r);
  add_lathe(soup, smoothed(placed, shape.smoothing), shape.around);
  add_block(soup, shape.plinth_half_m, abacus_bottom, h, kNoSide);
  return soup;
}

TriangleSoup vase(float height_m, int around, int smoothing) {
  const Profile outline{{0.24F, 0.00F}, {0.25F, 0.05F}, {0.13F, 0.12F}, {0.12F, 0.18F},
                        {0.30F, 0.34F}, {0.38F, 0.55F}, {0.34F, 0.78F}, {0.26F, 0.90F},
                        {0.34F, 1.00F}, {0.31F, 1.00F}, {0.23F, 0.89F}, {0.30F, 0.78F},
                        {0.32F, 0.60F}, {0.00F, 0.58F}};
  Profile placed;
  for (const glm::vec2& p : outline) placed.push_back(height_m * p);
  Profile curve = smoothed(placed, smoothing);
  for (glm::vec2& p : curve) p = {std::max(p.x, 0.0F), std::max(p.y, 0.0F)};
  TriangleSoup soup;
  add_lathe(soup, curve, around);
  return soup;
}

TriangleSoup plant(std::mt19937_64& engine, int leaves, int segments) {
  TriangleSoup soup;
  for (int leaf = 0; leaf < leaves; ++leaf) {
    const float azimuth = uniform(engine, 0.0F, kTwoPi);
    const float length_m = uniform(engine, 0.35F, 0.75F);
    const float lean = uniform(engine, 0.25F, 1.0F);
    const float half_width_m = uniform(engine, 0.025F, 0.05F);
    const glm::vec3 outwards = around_axis(1.0F, 0.0F, azimuth);
    const glm::vec3 sideways(outwards.z, 0.0F, -outwards.x);
    const auto point = [&](int i, int j) {
      const float t = static_cast<float>(j) / static_cast<float>(segments);
      const float width = half_width_m * std::sin(kTwoPi * 0.5F * (0.15F + 0.85F * t));
      const float bend = lean * t * t;
      const glm::vec3 spine = length_m * (outwards * (0.1F * t + 0.7F * bend) +
                                          glm::vec3(0.0F, t * (1.0F - 0.55F * bend), 0.0F));
      const float side = static_cast<float>(i - 1);
      return Corner{
          spine + side * width * sideways - (1.0F - std::abs(side)) * 0.3F * width * outwards,
          {0.5F + 0.5F * side, t}};
    };
    soup.add_grid(2, segments, point);
  }
  return soup;
}

}  // namespace renderers::scene

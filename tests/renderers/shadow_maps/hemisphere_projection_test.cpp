#include "renderers/shadow_maps/hemisphere_projection.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "renderers/ray_tracing/direction_sampling.h"

namespace renderers::shadow_maps {
namespace {

constexpr double kPi = std::numbers::pi;

glm::dvec3 polar_direction(double polar_rad, double azimuth_rad) {
  return {std::sin(polar_rad) * std::cos(azimuth_rad), std::sin(polar_rad) * std::sin(azimuth_rad),
          std::cos(polar_rad)};
}

std::vector<glm::dvec3> directions_over_hemisphere() {
  std::vector<glm::dvec3> directions;
  for (int i = 0; i <= 20; ++i) {
    for (int k = 0; k < 24; ++k) {
      directions.push_back(polar_direction(0.5 * kPi * i / 20.0, 2.0 * kPi * k / 24.0));
    }
  }
  return directions;
}

TEST(HemisphereProjection, GoesThereAndBack) {
  for (const glm::dvec3& direction : directions_over_hemisphere()) {
    const glm::dvec3 back = hemisphere_direction(hemisphere_position(direction));
    EXPECT_LT(glm::length(back - direction), 1e-12);
    EXPECT_LT(glm::length(back - hemisphere_direction(hemisphere_position(7.0 * direction))), 1e-12)
        << "the length counts";
  }
}

TEST(HemisphereProjection, MapsTheHorizonToTheUnitCircle) {
  EXPECT_NEAR(glm::length(hemisphere_position({0.6, 0.8, 0.0})), 1.0, 1e-15);
  EXPECT_EQ(hemisphere_position({0.0, 0.0, 1.0}), glm::dvec2(0.0));
  // r = tan(theta / 2).
  EXPECT_NEAR(hemisphere_position(polar_direction(kPi / 3.0, 0.0)).x, std::tan(kPi / 6.0), 1e-15);
}

/// Centre of the circle through three points.
glm::dvec2 circle_center(const std::array<glm::dvec2, 3>& p) {
  const glm::dmat2 rows(p[1] - p[0], p[2] - p[0]);
  const glm::dvec2 right(0.5 * (glm::dot(p[1], p[1]) - glm::dot(p[0], p[0])),
                         0.5 * (glm::dot(p[2], p[2]) - glm::dot(p[0], p[0])));
  return glm::inverse(glm::transpose(rows)) * right;
}

TEST(HemisphereProjection, CirclesStayCircles) {
  for (const double polar_rad : {0.2, 0.7, 1.2}) {
    for (const double radius_rad : {0.01, 0.3, 0.37}) {
      const glm::dmat3 frame = hemisphere_frame(polar_direction(polar_rad, 0.8));
      const auto image = [&](double azimuth_rad) {
        return hemisphere_position(frame * polar_direction(radius_rad, azimuth_rad));
      };
      const glm::dvec2 center = circle_center({image(0.0), image(2.0), image(4.0)});
      // The cap's circle as the shaders bound it: sin / (cos theta + cos rho).
      const double scale = std::cos(polar_rad) + std::cos(radius_rad);
      const double radius = std::sin(radius_rad) / scale;
      EXPECT_LT(glm::length(center - glm::dvec2(polar_direction(polar_rad, 0.8)) / scale), 1e-11);
      for (int k = 0; k < 40; ++k) {
        EXPECT_NEAR(glm::length(image(2.0 * kPi * k / 40.0) - center), radius, 1e-11);
      }
    }
  }
}

TEST(HemisphereProjection, IsConformal) {
  constexpr double kStep = 1e-6;
  for (const glm::dvec2 at : {glm::dvec2(0.0, 0.0), {0.3, -0.5}, {0.9, 0.4}, {-0.1, 0.99}}) {
    const glm::dvec3 along_x = (hemisphere_direction(at + glm::dvec2(kStep, 0.0)) -
                                hemisphere_direction(at - glm::dvec2(kStep, 0.0))) /
                               (2.0 * kStep);
    const glm::dvec3 along_y = (hemisphere_direction(at + glm::dvec2(0.0, kStep)) -
                                hemisphere_direction(at - glm::dvec2(0.0, kStep))) /
                               (2.0 * kStep);
    EXPECT_NEAR(glm::length(along_x), glm::length(along_y), 1e-8);
    EXPECT_NEAR(glm::dot(along_x, along_y), 0.0, 1e-8);
    EXPECT_NEAR(glm::length(glm::cross(along_x, along_y)), hemisphere_solid_angle_density(at),
                1e-8);
    // The texel's angle is its width, 2 / size, times that scale.
    EXPECT_NEAR(hemisphere_texel_angle(hemisphere_direction(at).z, 64),
                2.0 / 64.0 * glm::length(along_x), 1e-8);
  }
}

TEST(HemisphereProjection, TexelsCoverTheHemisphere) {
  for (const int size_px : {64, 128, 256}) {
    double sum_sr = 0.0;
    for (int y = 0; y < size_px; ++y) {
      for (int x = 0; x < size_px; ++x) sum_sr += hemisphere_texel_solid_angle({x, y}, size_px);
    }
    EXPECT_NEAR(sum_sr, 2.0 * kPi, 0.01 * 2.0 * kPi) << size_px;
  }
}

TEST(HemisphereProjection, TexelsHoldTheirCentres) {
  for (const int size_px : {1, 7, 64}) {
    for (int y = 0; y < size_px; ++y) {
      for (int x = 0; x < size_px; ++x) {
        const glm::ivec2 texel(x, y);
        EXPECT_EQ(hemisphere_texel(hemisphere_texel_center(texel, size_px), size_px), texel);
      }
    }
  }
  EXPECT_EQ(hemisphere_texel({1.0, -1.0}, 64), glm::ivec2(63, 0));
}

TEST(HemisphereProjection, RimTexelsLookAlongTheHorizon) {
  constexpr int kSize_px = 32;
  int rim_texels = 0;
  for (int y = 0; y < kSize_px; ++y) {
    for (int x = 0; x < kSize_px; ++x) {
      const glm::dvec2 center = hemisphere_texel_center({x, y}, kSize_px);
      const glm::dvec2 position = hemisphere_texel_position({x, y}, kSize_px);
      EXPECT_LE(glm::length(position), 1.0 + 1e-15);
      if (glm::length(center) <= 1.0) {
        EXPECT_EQ(position, center);
      } else if (hemisphere_texel_is_used({x, y}, kSize_px)) {
        ++rim_texels;
        EXPECT_NEAR(hemisphere_direction(position).z, 0.0, 1e-15);
        // Less than a texel's half diagonal away from the centre.
        EXPECT_LT(glm::length(position - center), std::numbers::sqrt2 / kSize_px + 1e-15);
      }
    }
  }
  EXPECT_GT(rim_texels, kSize_px);
  // Every direction above the horizon falls into a used texel.
  for (const glm::dvec3& direction : directions_over_hemisphere()) {
    const auto texel = hemisphere_texel(hemisphere_position(direction), kSize_px);
    EXPECT_TRUE(hemisphere_texel_is_used(texel, kSize_px));
  }
}

TEST(HemisphereProjection, HasTheFrameOfTheRayTracer) {
  for (const glm::vec3 axis : {glm::vec3(0, 0, 1),
                               {0, 0, -1},
                               {0, 1, 0},
                               {1, 0, -0.0F},
                               {0.36F, 0.48F, 0.8F},
                               {0.36F, -0.48F, -0.8F}}) {
    const auto expected = ray_tracing::frame_around(axis);
    const glm::dmat3 frame = hemisphere_frame(axis);
    EXPECT_LT(glm::length(frame[0] - glm::dvec3(expected.tangent)), 1e-6);
    EXPECT_LT(glm::length(frame[1] - glm::dvec3(expected.bitangent)), 1e-6);
    EXPECT_LT(glm::length(glm::cross(frame[0], frame[1]) - frame[2]), 1e-6);
  }
}

}  // namespace
}  // namespace renderers::shadow_maps

#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/scene/scene_file.h"
#include "tests/places.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// The closed forms of the scenes for shadows of bounced light.
namespace renderers::test {
namespace {

/// @param change  laid over the scene, YAML; may be empty
scene::Scene catalog_scene(const std::string& name, const std::string& change = "") {
  std::vector<base::Node> overlays;
  if (!change.empty()) overlays.push_back(base::parse_document(change, "change.yaml"));
  const auto path =
      std::filesystem::path(tests::kSourceFolder) / "suites/scenes" / (name + ".yaml");
  return scene::read_scene_file(path, overlays).at_frame(0);
}

/// What a spot lights, as a grid of points that pass its light on.
class SpotLitPoints {
 public:
  static constexpr int kSide = 96;

  explicit SpotLitPoints(const scene::Scene& scene) : scene_(scene), rays_(scene, timer_) {
    const scene::Light& spot = scene.lights.at(0);
    const ray_tracing::Frame3 frame = ray_tracing::frame_around(spot.direction);
    const float half_width = std::tan(spot.outer_cone_rad);
    for (int i = 0; i < kSide * kSide; ++i) {
      const float u = (2.0F * (static_cast<float>(i % kSide) + 0.5F) / kSide - 1.0F) * half_width;
      const float v = (2.0F * (static_cast<float>(i / kSide) + 0.5F) / kSide - 1.0F) * half_width;
      const glm::vec3 direction = glm::normalize(frame.to_world({u, v, 1.0F}));
      ray_tracing::Hit hit;
      const float intensity = scene::intensity_towards(spot, direction).y;
      if (intensity <= 0.0F || !rays_.intersect({spot.position, direction}, hit)) continue;
      const auto& material = scene.materials[static_cast<std::size_t>(hit.material)];
      const float cosine = glm::dot(direction, spot.direction);
      points_.push_back({hit, material.albedo.y * intensity * cosine * cosine * cosine});
    }
  }

  /// Irradiance of the bounced light, in a unit of its own.
  double irradiance_at(const glm::vec3& position, const glm::vec3& normal) const {
    double sum = 0.0;
    for (const Point& point : points_) {
      const glm::vec3 way = position - point.at.position;
      const float square = glm::dot(way, way);
      const float cosines =
          glm::dot(point.at.geometric_normal, way) * -glm::dot(normal, way) / square;
      if (cosines <= 0.0F || glm::dot(normal, way) >= 0.0F) continue;
      if (rays_.is_occluded(segment_to(point.at, position + 1e-4F * normal))) continue;
      sum += static_cast<double>(point.flux * cosines / square);
    }
    return sum;
  }

  /// Number of points by object and the axis that its normal is closest to (x, y, z).
  std::map<std::string, int> counts() const {
    std::map<std::string, int> counts;
    for (const Point& point : points_) {
      const glm::vec3 size = glm::abs(point.at.geometric_normal);
      const char* axis = size.x > 0.9F ? " x" : size.y > 0.9F ? " y" : " z";
      ++counts[scene_.objects[point.at.object].name + axis];
    }
    return counts;
  }

 private:
  struct Point {
    ray_tracing::SurfacePoint at;
    float flux;
  };

  StageTimer timer_;
  const scene::Scene& scene_;
  ray_tracing::RayScene rays_;
  std::vector<Point> points_;
};

/// Part of the patch's light that arrives on the line z = 0 of the floor.
class Scan {
 public:
  /// @param blockers  objects that are taken away for comparison
  Scan(const scene::Scene& scene, const std::vector<std::string>& blockers)
      : scene_(scene), open_scene_(scene), with_(scene_), without_(open(open_scene_, blockers)) {}

  double visible_at(float x) const {
    const glm::vec3 up(0.0F, 1.0F, 0.0F);
    return with_.irradiance_at({x, 0.0F, 0.0F}, up) / without_.irradiance_at({x, 0.0F, 0.0F}, up);
  }

 private:
  static const scene::Scene& open(scene::Scene& scene, const std::vector<std::string>& blockers) {
    std::erase_if(scene.objects, [&](const scene::Object& object) {
      return std::ranges::find(blockers, object.name) != blockers.end();
    });
    return scene;
  }

  scene::Scene scene_;
  scene::Scene open_scene_;
  SpotLitPoints with_;
  SpotLitPoints without_;
};

/// Part of a patch of side s that is seen past an edge at x = 0 of a plate that hides greater x.
double ramp(double x, double width) { return std::clamp(0.5 - x / width, 0.0, 1.0); }

std::string sized(double size_m, double height_m) {
  return fmt::format(
      "objects: {{patch: {{transform: {{scale: {0}}}}}, plate: {{transform: {{translate: "
      "{{1: {1}}}}}}}}}\nlights: {{spot: {{cone_deg: [{2}, {3}]}}}}\n",
      size_m, height_m, 22.5 * size_m, 25.0 * size_m);
}

TEST(PenumbraPlane, WidthIsTheClosedFormForEverySizeAndHeight) {
  constexpr double kPatchHeight_m = 2.0;
  struct Case {
    double size_m;
    double height_m;
  };
  for (const Case& c : {Case{0.4, 0.5}, {0.2, 0.5}, {0.8, 0.5}, {0.4, 0.2}, {0.4, 1.3}}) {
    const double width_m = c.size_m * c.height_m / (kPatchHeight_m - c.height_m);
    const Scan scan(catalog_scene("penumbra-plane", sized(c.size_m, c.height_m)), {"plate"});
    for (int i = -8; i <= 8; ++i) {
      const double x = width_m * i / 10.0;
      EXPECT_NEAR(scan.visible_at(static_cast<float>(x)), ramp(x, width_m), 0.03)
          << c.size_m << " " << c.height_m << " at " << x;
    }
  }
}

TEST(SoftAndCrisp, OnePenumbraIsNineTimesTheOther) {
  const Scan scan(catalog_scene("soft-and-crisp"), {"near-plate", "far-plate"});
  for (int i = -8; i <= 8; ++i) {
    const double near_x = 0.4 / 9.0 * i / 10.0;
    const double far_x = 0.4 * i / 10.0;
    EXPECT_NEAR(scan.visible_at(static_cast<float>(-0.5 - near_x)), ramp(near_x, 0.4 / 9.0), 0.05);
    EXPECT_NEAR(scan.visible_at(static_cast<float>(0.7 + far_x)), ramp(far_x, 0.4), 0.05);
  }
}

TEST(ThinOccluder, ShadowIsAsWideAsTheBarProjects) {
  for (const double width_m : {0.01, 0.04, 0.3}) {
    const Scan scan(
        catalog_scene(
            "thin-occluder",
            fmt::format("objects: {{bar: {{transform: {{scale: {{0: {}}}}}}}}}", width_m)),
        {"bar"});
    // The light that is missing along the line is that of the bar's projection from 2 m.
    const double shadow_m = width_m * 2.0 / 1.5;
    const double step_m = (shadow_m + 0.05) / 100.0;
    double missing_m = 0.0;
    for (int i = 0; i < 100; ++i) {
      missing_m += step_m * (1.0 - scan.visible_at(static_cast<float>(step_m * (i - 49.5))));
    }
    EXPECT_NEAR(missing_m, shadow_m, 0.05 * shadow_m) << width_m;
  }
}

TEST(ThinOccluder, TheBarLeavesNoLightBelowIt) {
  const Scan scan(catalog_scene("thin-occluder"), {"bar"});
  EXPECT_EQ(scan.visible_at(0.0F), 0.0);
  EXPECT_EQ(scan.visible_at(0.1F), 1.0);
}

TEST(ShadowScenes, TheSpotLightsThePatchAndNothingElse) {
  for (const char* name : {"penumbra-plane", "soft-and-crisp", "thin-occluder"}) {
    const scene::Scene scene = catalog_scene(name);
    const auto counts = SpotLitPoints(scene).counts();
    ASSERT_EQ(counts.size(), 1U) << name;
    EXPECT_GT(counts.at("patch y"), SpotLitPoints::kSide * SpotLitPoints::kSide / 10)
        << name << ": enough virtual lights meet it";
  }
}

TEST(LWall, OneSpotLightsBothFacesOfTheEdgeAndNothingElse) {
  const scene::Scene scene = catalog_scene("l-wall");
  const auto counts = SpotLitPoints(scene).counts();
  ASSERT_EQ(counts.size(), 2U);
  const double top = counts.at("block y");
  const double side = counts.at("block x");
  EXPECT_NEAR(top / (top + side), 0.5, 0.15);
}

TEST(LWall, ThePlateHidesTheLightBelowTheClustersPlane) {
  const scene::Scene scene = catalog_scene("l-wall");
  const SpotLitPoints points(scene);
  const glm::vec3 up(0.0F, 1.0F, 0.0F);
  const double before = points.irradiance_at({0.4F, 0.0F, 0.0F}, up);
  EXPECT_GT(before, 0.0);
  EXPECT_LT(points.irradiance_at({0.6F, 0.0F, 0.0F}, up), 0.05 * before) << "behind the plate";
  // The stud's shadow on the wall.
  const glm::vec3 right(1.0F, 0.0F, 0.0F);
  EXPECT_LT(points.irradiance_at({-1.2F, 1.3F, 0.0F}, right),
            0.2 * points.irradiance_at({-1.2F, 1.3F, 0.8F}, right));
}

}  // namespace
}  // namespace renderers::test

// A rectangle light behind a thin blocker: what every visibility says against rays to 256 points of
// the light.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/clustered_visibility/clustered_visibility_settings.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "tests/renderers/clustered_visibility/area_bench.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/scene_builder.h"

namespace test_clustered_visibility {
namespace {

constexpr int kSide = 48;  ///< receivers along x and z
constexpr float kReach_m = 0.8F;
constexpr int kPoints = 16;  ///< of the light along a side: 256 rays
constexpr int kMap_px = 256;
constexpr float kFarthest_m = 3.6F;
const glm::vec3 kLight{0.0F, 2.0F, 0.0F};
const glm::vec3 kHalfWidth{0.3F, 0.0F, 0.0F};
const glm::vec3 kHalfLength{0.0F, 0.0F, 0.15F};
const glm::vec3 kUp{0.0F, 1.0F, 0.0F};

/// A floor and above it a bar of 4 cm, oblique to the light's sides, whose ends are seen.
renderers::scene::Scene floor_and_bar() {
  renderers::test::SceneBuilder builder;
  const int white = builder.add_material(renderers::test::lambert(glm::vec3(0.5F)));
  builder.add_quad({-2.0F, 0.0F, -2.0F}, {0.0F, 0.0F, 4.0F}, {4.0F, 0.0F, 0.0F}, white);
  constexpr float kAngle = 25.0F * std::numbers::pi_v<float> / 180.0F;
  const glm::vec3 along(std::cos(kAngle), 0.0F, std::sin(kAngle));
  const glm::vec3 across(-along.z, 0.0F, along.x);
  constexpr float kHalfBar_m = 0.45F;
  constexpr float kHalfThickness_m = 0.02F;
  const glm::vec3 corner =
      glm::vec3(0.0F, 0.8F, 0.0F) - kHalfBar_m * along - kHalfThickness_m * across;
  builder.add_quad(corner, 2.0F * kHalfBar_m * along, 2.0F * kHalfThickness_m * across, white);
  return builder.scene;
}

glm::vec3 receiver_at(int index) {
  const auto place = [](int i) {
    return kReach_m * (2.0F * (static_cast<float>(i) + 0.5F) / kSide - 1.0F);
  };
  return {place(index % kSide), 0.0F, place(index / kSide)};
}

/// Share of the light's points that a receiver sees.
double seen_share(const renderers::ray_tracing::RayScene& rays, const glm::vec3& receiver) {
  constexpr float kAbove_m = 1e-4F;
  const glm::vec3 origin = receiver + kAbove_m * kUp;
  int seen = 0;
  for (int i = 0; i < kPoints * kPoints; ++i) {
    const auto share = [](int step) {
      return 2.0F * (static_cast<float>(step) + 0.5F) / kPoints - 1.0F;
    };
    const glm::vec3 point =
        kLight + share(i % kPoints) * kHalfWidth + share(i / kPoints) * kHalfLength;
    seen += rays.is_occluded({origin, point - origin, 1.0F}) ? 0 : 1;
  }
  return static_cast<double>(seen) / (kPoints * kPoints);
}

cv::Settings settings_of(const char* preset, const std::vector<std::string>& more) {
  std::vector<base::ParameterSetting> parsed;
  for (const std::string& text : more) parsed.push_back(base::parse_setting(text, "test"));
  for (const base::Preset& each : cv::presets()) {
    if (each.name != preset) continue;
    return cv::settings_of(
        base::resolve_parameters(cv::parameter_specs(), &each, parsed, "clustered-visibility"));
  }
  throw std::logic_error("no such preset");
}

double root_mean_square(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

class RectangleLight : public renderers::test::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    const renderers::scene::Scene scene = floor_and_bar();
    renderers::StageTimer timer;
    const renderers::ray_tracing::RayScene rays(scene, timer);
    surfaces_ = renderers::test::empty_surfaces(kSide, kSide);
    for (int i = 0; i < kSide * kSide; ++i) {
      renderers::test::put_flat(surfaces_, static_cast<std::size_t>(i), receiver_at(i), kUp);
      truth_.push_back(seen_share(rays, receiver_at(i)));
    }
    cv::AreaLight area = light_above(kLight, 0.0F, kFarthest_m);
    area.shape.z = 4.0F * kHalfWidth.x * kHalfLength.z;
    area.shape.x = std::sqrt(area.shape.z);
    bench_.emplace(context(), scene, area, kMap_px);
  }
  void TearDown() override {
    bench_.reset();
    GlTest::TearDown();
  }
  std::vector<double> visibility(const char* preset, const std::vector<std::string>& more) const {
    const cv::Settings settings = settings_of(preset, more);
    return bench_->visibility(surfaces_, settings.area, settings.convolution);
  }
  double error(const char* preset, const std::vector<std::string>& more) const {
    return root_mean_square(visibility(preset, more), truth_);
  }

  std::optional<AreaBench> bench_;
  renderers::many_lights::SurfaceImage surfaces_;
  std::vector<double> truth_;
};

struct Gate {
  const char* preset;
  const char* visibility;
  double measured;  ///< root mean square of the differences to rays
};
// By a square light of the same area, as the technique has it. The bar takes a third of the light
// or less. The series of the preset `paper` is farther from the rays than no shadow at all, which
// differs by 0.094: the raw depth of blockers gives so narrow a kernel that the darkest receiver
// sees 0.02 of the light in place of 0.65; corrected, it loses the bar.
constexpr Gate kGates[] = {
    {"paper", "visibility=cssm", 0.1148}, {"paper", "visibility=pcf", 0.0353},
    {"best", "visibility=cssm", 0.0364},  {"best", "visibility=pcf", 0.0226},
    {"best", "visibility=msm", 0.0350},
};
constexpr double kMargin = 1.1;

TEST_F(RectangleLight, BehindAThinBarIsSeenAsRaysSeeItWithinTheErrorMeasured) {
  EXPECT_NEAR(std::ranges::min(truth_), 0.65, 0.03) << "the bar's shadow";
  EXPECT_EQ(std::ranges::max(truth_), 1.0);
  for (const Gate& gate : kGates) {
    const double own = error(gate.preset, {gate.visibility});
    EXPECT_LT(own, kMargin * gate.measured) << gate.preset << " " << gate.visibility;
  }
}

TEST_F(RectangleLight, OneTestInItsMapPassesNoGate) {
  for (const Gate& gate : kGates) {
    EXPECT_GT(error(gate.preset, {"visibility=hard"}), kMargin * gate.measured);
  }
}

TEST_F(RectangleLight, NoShadowAtAllPassesNoGateButThePapers) {
  const std::vector<double> lit(truth_.size(), 1.0);
  for (const Gate& gate : kGates) {
    const bool is_paper_series = &gate == &kGates[0];
    EXPECT_EQ(root_mean_square(lit, truth_) > kMargin * gate.measured, !is_paper_series);
  }
}

}  // namespace
}  // namespace test_clustered_visibility

#include "renderers/light_propagation/surface_samples.h"

#include <cmath>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "renderers/light_propagation/sample_light.h"
#include "tests/renderers/area_shadows/polygon_irradiance.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::light_propagation {
namespace {

using test::lambert;
using test::SceneBuilder;

/// A scene's rays and the volume around it. The scene must live as long as this.
struct Bench {
  Bench(const scene::Scene& scene, int cells)
      : rays(scene, timer), grid(grid_around({rays.box_min(), rays.box_max()}, cells)) {}
  StageTimer timer;
  ray_tracing::RayScene rays;
  Grid grid;

  double area_m2() const {
    double sum = 0.0;
    for (std::uint32_t object = 0; object < rays.scene().objects.size(); ++object) {
      const auto count = rays.scene().objects[object].mesh->triangles.size();
      for (std::uint32_t t = 0; t < count; ++t) {
        sum += static_cast<double>(rays.triangle_area_m2(object, t));
      }
    }
    return sum;
  }
  std::vector<SurfaceSample> samples(const SampleSettings& settings = {}) const {
    return sample_surfaces(rays, grid, settings);
  }
  double injected_w(const SampleSettings& settings) const {
    const auto found = samples(settings);
    return inject(grid, found, light_samples(rays, found, 64).samples).flux().x;
  }
};

double area_of(const std::vector<SurfaceSample>& samples) {
  double sum = 0.0;
  for (const SurfaceSample& sample : samples) sum += static_cast<double>(sample.area_m2);
  return sum;
}

scene::Scene still_life() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.7F)));
  builder.add_box({-1, -1, -1}, {1, 1, 1}, white, true);
  builder.add_sphere({0.2F, -0.3F, 0.1F}, 0.4F, 20, white);
  builder.add_quad({-0.9F, 0.2F, -0.3F}, {0.5F, 0.2F, 0}, {0, 0.1F, 0.7F}, white);
  return builder.scene;
}

TEST(SurfaceSamples, PiecesAndSamplesHaveTheSurfacesArea) {
  const scene::Scene scene = still_life();
  for (const int cells : {7, 16}) {
    const Bench bench(scene, cells);
    double cut = 0.0;
    glm::dvec3 vector_area(0.0);
    for (const CellSurface& surface : cut_surfaces(bench.rays, bench.grid)) {
      cut += surface.area_m2;
      vector_area += surface.vector_area_m2;
    }
    EXPECT_NEAR(cut / bench.area_m2(), 1.0, 1e-4);
    EXPECT_NEAR(area_of(bench.samples()) / bench.area_m2(), 1.0, 1e-4);
    // Closed surfaces cancel; the quad stays: cross((0.5, 0.2, 0), (0, 0.1, 0.7)).
    EXPECT_NEAR(glm::distance(vector_area, glm::dvec3(0.14, -0.35, 0.05)), 0.0, 1e-4);
  }
}

TEST(SurfaceSamples, DartsKeepTheirDistance) {
  const scene::Scene scene = still_life();
  const Bench bench(scene, 8);
  SampleSettings settings;
  settings.per_cell_face = 4.0;
  const auto samples = bench.samples(settings);
  const double face_m2 = static_cast<double>(bench.grid.cell_m * bench.grid.cell_m);
  EXPECT_GT(static_cast<double>(samples.size()), 4.0 * bench.area_m2() / face_m2);
  // Samples that fill empty cells may stand near others; darts may not.
  int near = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const bool faces_alike =
          glm::dot(samples[i].point.geometric_normal, samples[j].point.geometric_normal) > 0.5F;
      const float distance_m = glm::distance(samples[i].point.position, samples[j].point.position);
      if (faces_alike && distance_m < 0.385F * bench.grid.cell_m) ++near;
    }
  }
  EXPECT_LT(near, static_cast<int>(samples.size()) / 10);
}

/// The floor's flux is the integral of the lamp's exact irradiance.
TEST(SurfaceSamples, InjectedPowerIsWhatTheSurfacesReflect) {
  const test::LampOverFloor lamp;
  const scene::Scene scene = lamp.scene().scene;
  constexpr int kPlaces = 80;
  double expected = 0.0;
  for (int y = 0; y < kPlaces; ++y) {
    for (int x = 0; x < kPlaces; ++x) expected += lamp.irradiance(lamp.point(x, y, kPlaces));
  }
  expected *= 16.0 / (kPlaces * kPlaces);
  const Bench bench(scene, 16);
  EXPECT_NEAR(bench.injected_w({}), expected, 0.02 * expected);
  SampleSettings twice;
  twice.per_cell_face = 8.0;
  EXPECT_NEAR(bench.injected_w(twice), bench.injected_w({}), 0.02 * expected);
}

/// Cells that are partly filled: dividing by the number of samples makes them as bright as full
/// ones, which must fail.
TEST(SurfaceSamples, PartlyFilledCellsReflectTheirShare) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(1.0F)));
  const int glow = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  builder.add_quad({-0.5F, 2, -0.5F}, {1, 0, 0}, {0, 0, 1}, glow);
  for (int i = 0; i < 25; ++i) {
    const glm::vec3 corner(0.4F * static_cast<float>(i % 5 - 2), 0.0F,
                           0.4F * static_cast<float>(i / 5 - 2));
    builder.add_quad(corner, {0, 0, 0.1F}, {0.1F, 0, 0}, white);
  }
  const Bench bench(builder.scene, 12);
  double expected = 0.0;
  for (int i = 0; i < 25; ++i) {
    const glm::dvec3 middle(0.4 * (i % 5 - 2) + 0.05, 0.0, 0.4 * (i / 5 - 2) + 0.05);
    expected += 0.01 * test::polygon_irradiance(
                           middle, {0, 1, 0},
                           {{-0.5, 2, -0.5}, {0.5, 2, -0.5}, {0.5, 2, 0.5}, {-0.5, 2, 0.5}});
  }
  EXPECT_NEAR(bench.injected_w({}), expected, 0.02 * expected);
  SampleSettings counted;
  counted.area = SampleArea::count;
  EXPECT_GT(bench.injected_w(counted), 1.5 * expected);
}

}  // namespace
}  // namespace renderers::light_propagation

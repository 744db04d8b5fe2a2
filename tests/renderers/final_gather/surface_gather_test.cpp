#include "renderers/final_gather/surface_gather.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "renderers/final_gather/surface_choice.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"
#include "tests/renderers/final_gather/grid_fixture.h"

/// Senders of the vertices of patches, and of patches by themselves.
namespace renderers::test {
namespace {

using element_hierarchy::Element;
using element_hierarchy::PatchVertices;
using final_gather::Receiver;
using final_gather::SurfaceVertices;
using Settings = std::vector<std::string>;

Frame gathered(const scene::Scene& scene, Settings settings, int threads = 0,
               const char* renderer = "surface-final-gather") {
  settings.insert(settings.begin(), {"link_budget=1000", "border_rays=1"});
  return render(scene, {.renderer = renderer,
                        .settings = std::move(settings),
                        .width_px = 16,
                        .height_px = 16,
                        .threads = threads});
}

/// Patches of many sizes, so that vertices hang on larger neighbours' edges.
TEST(PatchVertices, WhatBearsAVertexHasItsPlaceAsMean) {
  const SceneBuilder builder = closed_room();
  const SolvedScene solved(builder.scene, solver_settings(3000));
  const PatchVertices vertices(solved.tree());
  std::map<std::uint32_t, glm::vec3> places;
  for (std::uint32_t i = 0; i < solved.elements().size(); ++i) {
    if (!solved.tree().at(i).is_patch) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      places[vertices.of(i)[c]] = solved.tree().at(i).positions[c];
    }
  }
  std::size_t hanging = 0;
  for (const auto& [vertex, place] : places) {
    std::vector<PatchVertices::Weighted> bearing;
    vertices.add_bearing(vertex, 0.5F, bearing);
    glm::vec3 sum(0.0F);
    float weight = 0.0F;
    for (const PatchVertices::Weighted& one : bearing) {
      sum += one.weight * places.at(one.vertex);
      weight += one.weight;
    }
    EXPECT_NEAR(weight, 0.5F, 1e-6F);
    EXPECT_LT(glm::distance(2.0F * sum, place), 1e-5F);
    hanging += bearing.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(hanging, 10U);
}

/// Squares in one plane, whose halves are cut and whole: the middle of each one's diagonal is the
/// other's corner.
TEST(PatchVertices, CornersOfSurfacesThatOverlapDoNotRestOnEachOther) {
  SceneBuilder builder;
  const int gray = builder.add_material(lambert(glm::vec3(0.5F), glm::vec3(1.0F)));
  builder.add_quad({0, 0, 0}, {0, 0, 2}, {2, 0, 0}, gray);
  builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, gray);
  builder.add_quad({-3, 3, -3}, {6, 0, 0}, {0, 0, 6}, gray);
  StageTimer timer;
  const ray_tracing::RayScene rays(builder.scene, timer, ray_tracing::RayQueries::all_hits);
  auto solution = element_hierarchy::solve_radiosity(rays, solver_settings(16), timer);
  element_hierarchy::ElementTree& tree = *solution->tree;
  for (const std::uint32_t root :
       std::vector<std::uint32_t>(tree.roots().begin(), tree.roots().end())) {
    const Element& side = tree.at(root);
    if (side.object < 2 && side.triangle == 0 && side.is_leaf()) tree.subdivide(root);
  }
  const PatchVertices vertices(tree);
  for (std::uint32_t i = 0; i < tree.elements().size(); ++i) {
    if (!tree.at(i).is_patch) continue;
    for (const std::uint32_t corner : vertices.of(i)) {
      std::vector<PatchVertices::Weighted> bearing;
      vertices.add_bearing(corner, 1.0F, bearing);
      float weight = 0.0F;
      for (const PatchVertices::Weighted& one : bearing) weight += one.weight;
      EXPECT_NEAR(weight, 1.0F, 1e-6F);
    }
  }
}

/// A scene with what a surface gather makes of one view of it.
struct SurfaceScene {
  SurfaceScene(const scene::Scene& scene, bool by_patches, std::size_t links = 1000)
      : grid(scene, {}, {}, links),
        vertices(*grid.solution->tree),
        surface(*grid.solution->tree, by_patches ? nullptr : &vertices, grid.seen,
                std::vector<bool>(grid.seen.size(), true)),
        classifier(grid.classes, surface, final_gather::VertexVisibility::rays,
                   {grid.job.camera.position,
                    glm::normalize(grid.job.camera.look_at - grid.job.camera.position), 16.0}),
        gather(grid.transfer, surface, classifier) {}

  GridScene grid;
  PatchVertices vertices;
  SurfaceVertices surface;
  final_gather::SurfaceClassifier classifier;
  final_gather::SurfaceGather gather;
};

TEST(SurfaceVertices, WeightsOfWhatTheCameraSeesSumToOne) {
  const SceneBuilder builder = closed_room();
  for (const bool by_patches : {false, true}) {
    const SurfaceScene scene(builder.scene, by_patches, 3000);
    for (const final_gather::Anchor& anchor : scene.grid.seen) {
      const auto point =
          scene.grid.rays.point_on_triangle(anchor.object, anchor.triangle, anchor.barycentrics);
      float weight = 0.0F;
      for (const auto& one : scene.surface.around(point, anchor.towards)) weight += one.weight;
      EXPECT_NEAR(weight, 1.0F, 1e-5F);
    }
    for (std::size_t site = 0; site < scene.surface.count(); ++site) {
      EXPECT_FALSE(scene.surface.leaves(site).empty());
      EXPECT_FALSE(scene.surface.anchors(site).empty());
      if (by_patches) {
        EXPECT_EQ(scene.surface.leaves(site).size(), 1U);
      }
    }
  }
}

/// A vertex where floor and wall meet sees half of the wall's light, as points beside it do: on the
/// wall's very plane it would see nothing of it.
TEST(SurfaceVertices, LieBeforeWallsThatStandOnThem) {
  SceneBuilder builder;
  const int floor = builder.add_material(lambert(glm::vec3(0.5F)));
  const int wall = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  builder.add_quad({-1, 0, 0}, {0, 0, 2}, {2, 0, 0}, floor);
  builder.add_quad({-50, 0, 2}, {0, 50, 0}, {100, 0, 0}, wall);
  builder.look({0, 2, -0.5F}, {0, 0, 1.2F}, 70.0F);
  const SurfaceScene scene(builder.scene, false, 100);
  double most = 0.0;
  for (std::size_t site = 0; site < scene.surface.count(); ++site) {
    const auto place = scene.surface.place(site).surface.position;
    if (std::abs(place.x) > 0.5F || place.z < 1.9F) continue;
    double form_factor = 0.0;
    for (const auto& record : scene.gather.vertices()[site].records) {
      form_factor += static_cast<double>(record.form_factor);
    }
    most = std::max(most, form_factor);
  }
  EXPECT_NEAR(most, 0.5, 0.05);
}

TEST(SurfaceGather, ResamplingEverythingIsTheFullGather) {
  const SceneBuilder builder = closed_room();
  const Frame full = gathered(builder.scene, {}, 0, "final-gather");
  const Settings all{"resample_all=true", "penumbra_bound=false", "contrast_bound=false"};
  // A patch has the senders of its links.
  Settings by_patches = all;
  by_patches.push_back("decided_for=patches");
  const Frame patches = gathered(builder.scene, by_patches);
  EXPECT_EQ(counter(patches, "records_interpolated"), 0.0);
  EXPECT_LT(relative_difference(patches.radiance, full.radiance), 0.01);
  const Frame resampled = gathered(builder.scene, all);
  EXPECT_LT(relative_difference(resampled.radiance, full.radiance), 0.02);
  for (const char* visibility : {"vertex_visibility=rays", "vertex_visibility=links"}) {
    const Frame steered = gathered(builder.scene, {visibility});
    EXPECT_LT(relative_difference(steered.radiance, full.radiance), 0.08) << visibility;
    EXPECT_LT(counter(steered, "visibility_samples"),
              0.4 * counter(resampled, "visibility_samples"));
  }
}

TEST(SurfaceGather, AFurnaceIsConstant) {
  SceneBuilder builder;
  const glm::vec3 emission(1.0F / std::numbers::pi_v<float>);
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F),
                  builder.add_material(lambert(glm::vec3(0.5F), emission)), true);
  builder.look({0.1F, 0.2F, -0.5F}, {0, 0, 1}, 70.0F);
  for (const char* decided_for : {"decided_for=vertices", "decided_for=patches"}) {
    const Frame frame = gathered(builder.scene, {decided_for});
    double sum = 0.0;
    for (const float value : frame.radiance.pixels) {
      EXPECT_NEAR(value, 2.0F / std::numbers::pi_v<float>, 0.08F) << decided_for;
      sum += static_cast<double>(value);
    }
    EXPECT_NEAR(sum / static_cast<double>(frame.radiance.pixels.size()), 2.0 / std::numbers::pi,
                0.015)
        << decided_for;
  }
}

TEST(SurfaceGather, BlindViewersNeedNoSamples) {
  const SceneBuilder builder = closed_room();
  const Frame frame = gathered(builder.scene, {"threshold_scale=1e6"});
  EXPECT_EQ(counter(frame, "visibility_samples"), 0.0);
  EXPECT_EQ(counter(frame, "form_factor_samples"), 0.0);
  EXPECT_GT(counter(frame, "records_interpolated"), 100.0);
  const Frame of_links = gathered(builder.scene, {"vertex_visibility=links"});
  EXPECT_LT(counter(of_links, "class_visibility_samples"),
            0.5 * counter(frame, "class_visibility_samples"));
}

/// Irradiance along a line over the floor, where nothing occludes: largest step between places a
/// ten thousandth of the line apart, over the mean.
double largest_step(const SurfaceScene& scene) {
  double last = -1.0;
  double most = 0.0;
  double sum = 0.0;
  constexpr int kPlaces = 10000;
  for (int i = 0; i < kPlaces; ++i) {
    const float t = 0.2F + 0.6F * static_cast<float>(i) / kPlaces;
    Receiver receiver;
    receiver.point = scene.grid.rays.point_on_triangle(0, 0, {0.9F * t, 0.05F + 0.04F * t});
    receiver.normal = {0, 1, 0};
    const auto light = static_cast<double>(scene.gather.at(receiver).irradiance.x);
    if (last >= 0.0) most = std::max(most, std::abs(light - last));
    last = light;
    sum += light;
  }
  return most * kPlaces / sum;
}

/// The lamp hangs so high that some patches interpolate its light and others do not.
TEST(SurfaceGather, VerticesHaveNoSeamsAndPatchesHave) {
  SceneBuilder builder;
  const int floor = builder.add_material(lambert(glm::vec3(0.6F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.2F), glm::vec3(2.0F)));
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, floor);
  builder.add_quad({-0.5F, 3.5F, -0.5F}, {1, 0, 0}, {0, 0, 1}, lamp);
  builder.look({0, 5.0F, -0.1F}, {0, 0, 0}, 60.0F);
  const double of_vertices = largest_step(SurfaceScene(builder.scene, false, 300));
  EXPECT_LT(of_vertices, 0.002);  // what the light itself changes by
  EXPECT_GT(largest_step(SurfaceScene(builder.scene, true, 300)), 6.0 * of_vertices);
}

TEST(SurfaceGather, SameBytesForEveryNumberOfThreads) {
  const SceneBuilder builder = closed_room();
  const Frame one = gathered(builder.scene, {"class_samples=32", "gather_samples=32"}, 1);
  const Frame two = gathered(builder.scene, {"class_samples=32", "gather_samples=32"}, 2);
  EXPECT_EQ(one.radiance.pixels, two.radiance.pixels);
}

/// Sec. 4.5: surfaces cut finer than the grid, not those that are small already.
TEST(SurfaceChoice, TakesWhatIsCutFinerThanTheGrid) {
  SceneBuilder builder = closed_room();
  const SolvedScene solved(builder.scene, solver_settings(3000));
  const auto chosen = [&](int cells) {
    const final_gather::GatherGrid grid(builder.scene.camera, {cells, cells, cells},
                                        glm::dvec3(-1.0), glm::dvec3(1.0),
                                        final_gather::GridBlending::tetrahedra);
    const final_gather::SurfaceChoice choice(solved.tree(), final_gather::SurfaceUse::finely_cut,
                                             &grid);
    std::size_t count = 0;
    for (const std::uint32_t root : solved.tree().roots()) {
      if (!choice.is_on_surface(root)) continue;
      ++count;
      EXPECT_FALSE(solved.tree().at(root).is_leaf());
    }
    return count;
  };
  EXPECT_GT(chosen(1), 0U);
  EXPECT_LE(chosen(4), chosen(1));
  EXPECT_EQ(chosen(1000), 0U);
  const final_gather::SurfaceChoice all(solved.tree(), final_gather::SurfaceUse::always, nullptr);
  const final_gather::SurfaceChoice none(solved.tree(), final_gather::SurfaceUse::never, nullptr);
  for (const std::uint32_t root : solved.tree().roots()) {
    EXPECT_TRUE(all.is_on_surface(root));
    EXPECT_FALSE(none.is_on_surface(root));
  }
}

/// Both kinds of vertices in one picture.
TEST(GridGather, LeavesFinelyCutSurfacesToTheirPatches) {
  const SceneBuilder builder = closed_room();
  const Frame full = gathered(builder.scene, {}, 0, "final-gather");
  const Settings few{"grid_vertices=30"};
  const Frame both = gathered(builder.scene, few, 0, "grid-final-gather");
  EXPECT_GT(counter(both, "surface_vertices"), 0.0);
  EXPECT_GT(counter(both, "touched_vertices"), 0.0);
  const perception::Image& by_surface = aov(both, "by_surface");
  EXPECT_GT(std::ranges::count(by_surface.pixels, 1.0F), 10);
  EXPECT_GT(std::ranges::count(by_surface.pixels, 0.0F), 10);
  EXPECT_LT(relative_difference(both.radiance, full.radiance), 0.08);
}

}  // namespace
}  // namespace renderers::test

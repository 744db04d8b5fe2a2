#include "renderers/final_gather/grid_gather.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/renderers/final_gather/grid_fixture.h"

/// Senders of grid vertices, their classes, and what is made of them.
namespace renderers::test {
namespace {

using final_gather::ClassSettings;
using final_gather::GatherVertex;
using final_gather::Receiver;
using final_gather::Sender;
using final_gather::SenderRecord;
using Settings = std::vector<std::string>;

Frame gridded(const scene::Scene& scene, Settings settings, int threads = 0) {
  settings.insert(settings.begin(), {"link_budget=1000", "grid_vertices=150", "border_rays=1",
                                     "surface_gather=never"});
  return render(scene, {.renderer = "grid-final-gather",
                        .settings = std::move(settings),
                        .width_px = 16,
                        .height_px = 16,
                        .threads = threads});
}

/// Every whole side below the sources of a neighbourhood's links lies below exactly one sender.
TEST(SenderList, CountsEverySourceOnce) {
  const SceneBuilder builder = closed_room();
  const SolvedScene solved(builder.scene, solver_settings(3000));
  const auto& tree = solved.tree();
  // All leaves as one neighbourhood: the worst mixture of levels.
  std::vector<std::uint32_t> leaves;
  std::set<std::uint32_t> sources;
  for (std::uint32_t i = 0; i < solved.elements().size(); ++i) {
    if (tree.at(i).is_leaf()) leaves.push_back(i);
    for (const auto& link : std::as_const(solved.solution->links).of(i))
      sources.insert(link.source);
  }
  const std::vector<Sender> senders = final_gather::collect_senders(*solved.solution, leaves);
  std::set<std::uint32_t> elements;
  for (const Sender& sender : senders) elements.insert(sender.element);
  EXPECT_EQ(elements.size(), senders.size());
  std::size_t nested = 0;
  for (const std::uint32_t leaf : leaves) {
    int above = 0;
    bool is_source = false;
    int sources_above = 0;
    for (std::uint32_t i = leaf; i != element_hierarchy::kNoElement; i = tree.at(i).parent) {
      above += elements.contains(i) ? 1 : 0;
      is_source = is_source || sources.contains(i);
      sources_above += sources.contains(i) ? 1 : 0;
    }
    EXPECT_EQ(above, is_source ? 1 : 0);
    nested += sources_above > 1 ? 1 : 0;
  }
  EXPECT_GT(nested, leaves.size() / 2);  // the links' sources by themselves are not disjoint
}

TEST(SenderList, KeepsALinksIrradianceWhenItIsOpened) {
  const SceneBuilder builder = closed_room();
  const SolvedScene solved(builder.scene, solver_settings(3000));
  std::vector<std::uint32_t> one;
  for (std::uint32_t i = 0; i < solved.elements().size() && one.empty(); ++i) {
    if (solved.tree().at(i).is_leaf()) one.push_back(i);
  }
  double from_links = 0.0;
  for (std::uint32_t i = one.front(); i != element_hierarchy::kNoElement;
       i = solved.tree().at(i).parent) {
    for (const auto& link : std::as_const(solved.solution->links).of(i)) {
      from_links += static_cast<double>(element_hierarchy::from_log_code(link.irradiance));
    }
  }
  double from_senders = 0.0;
  for (const Sender& sender : final_gather::collect_senders(*solved.solution, one)) {
    from_senders += sender.irradiance;
  }
  EXPECT_NEAR(from_senders, from_links, 1e-6 * from_links);
}

TEST(GridGather, ResamplingEverythingIsTheFullGather) {
  const SceneBuilder builder = closed_room();
  const Frame full = render(builder.scene, {.renderer = "final-gather",
                                            .settings = {"link_budget=1000", "border_rays=1"},
                                            .width_px = 16,
                                            .height_px = 16});
  const Settings all{"resample_all=true", "penumbra_bound=false", "contrast_bound=false"};
  const Frame resampled = gridded(builder.scene, all);
  EXPECT_EQ(counter(resampled, "records_interpolated"), 0.0);
  // Other senders stand for the same sources where vertices join links of several leaves.
  EXPECT_LT(relative_difference(resampled.radiance, full.radiance), 0.02);
  const Frame steered = gridded(builder.scene, {});
  EXPECT_LT(relative_difference(steered.radiance, full.radiance), 0.06);
  EXPECT_LT(counter(steered, "visibility_samples"), 0.4 * counter(resampled, "visibility_samples"));
}

TEST(GridGather, BlindViewersNeedNoSamples) {
  const SceneBuilder builder = closed_room();
  const Frame frame = gridded(builder.scene, {"threshold_scale=1e6"});
  EXPECT_EQ(counter(frame, "visibility_samples"), 0.0);
  EXPECT_EQ(counter(frame, "form_factor_samples"), 0.0);
  EXPECT_GT(counter(frame, "records_interpolated"), 100.0);
}

/// A stack of plates with light from above and a little from the side: a ceiling sees its bright
/// top alone. What interpolation takes of it as few senders is what samples on them say; their mean
/// radiosities are half of that, and what they send, to each other most of all, a sixth.
TEST(GridGather, AClusterSendsWhatIsSeenOfIt) {
  SceneBuilder builder;
  const int gray = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}, gray);
  for (int i = 0; i < 6; ++i) {
    builder.add_quad({-0.3F, -0.15F * static_cast<float>(i), -0.3F}, {0, 0, 0.6F}, {0.6F, 0, 0},
                     gray);
  }
  scene::Light lamp;
  lamp.type = scene::LightType::spot;
  lamp.position = {0, 0.7F, 0};
  lamp.intensity = glm::vec3(100.0F);
  lamp.inner_cone_rad = lamp.outer_cone_rad = 0.5F;
  builder.scene.lights.push_back(lamp);
  builder.add_point_light({0, 2.8F, 0}, glm::vec3(1e-3F));
  builder.add_point_light({0, -0.35F, -1.5F}, glm::vec3(0.1F));
  builder.look({0, 2.2F, -1}, {0, 3, 0}, 50.0F);
  int clusters = 0;
  const auto light_of = [&](const ClassSettings& classes,
                            const final_gather::PerceptionSettings& perception) {
    const GridScene scene(builder.scene, classes, perception, 48);
    const auto& tree = *scene.solution->tree;
    for (const GatherVertex& vertex : scene.gather.vertices()) {
      for (const SenderRecord& record : vertex.records) {
        clusters += tree.at(record.sender).is_patch ? 0 : 1;
      }
    }
    Receiver receiver;
    receiver.point = scene.rays.point_on_triangle(0, 0, {0.3F, 0.3F});
    receiver.normal = {0, -1, 0};
    return static_cast<double>(scene.gather.at(receiver).irradiance.x);
  };
  const double sampled = light_of({.resamples_all = true}, {});
  const double stored = light_of({}, {.threshold_scale = 1e6});
  EXPECT_GT(clusters, 100);
  EXPECT_NEAR(stored, sampled, 0.05 * sampled);
}

TEST(GridGather, EveryClassOccurs) {
  const SceneBuilder builder = closed_room();
  const Frame frame = gridded(builder.scene, {"threshold_scale=0.3", "masking=false"});
  for (const char* name : {"records_interpolated", "records_visibility_resampled",
                           "records_form_factor_resampled", "records_both_resampled"}) {
    EXPECT_GT(counter(frame, name), 0.0) << name;
  }
}

/// What was decided for the senders of a pixel, as a picture.
TEST(GridGather, ClassesOfAPixelAddUpToWhatIsEvaluatedThere) {
  const SceneBuilder builder = closed_room();
  const Frame frame = gridded(builder.scene, {"threshold_scale=0.3", "masking=false"});
  const auto aov = [&](const Frame& of, const std::string& name) -> const perception::Image& {
    for (const perception::NamedImage& image : of.aovs) {
      if (image.name == name) return image.image;
    }
    throw std::out_of_range(name);
  };
  const perception::Image& classes = aov(frame, "classes");
  const perception::Image& resampled = aov(frame, "resampled");
  std::array<double, 3> sums{};
  for (std::size_t i = 0; i < resampled.pixels.size(); ++i) {
    float sum = 0.0F;
    for (std::size_t c = 0; c < 3; ++c) {
      sum += classes.pixels[3 * i + c];
      sums[c] += static_cast<double>(classes.pixels[3 * i + c]);
    }
    EXPECT_NEAR(sum, resampled.pixels[i], 1e-5F);
    EXPECT_LE(sum, 1.0F + 1e-4F);
  }
  for (const double sum : sums) EXPECT_GT(sum, 0.0);
  // The full gather evaluates both, of every sender.
  const Frame full = render(builder.scene, {.renderer = "final-gather",
                                            .settings = {"link_budget=1000", "border_rays=1"},
                                            .width_px = 4,
                                            .height_px = 4});
  EXPECT_EQ(aov(full, "classes").at(1, 1, 0), 0.0F);
  EXPECT_EQ(aov(full, "classes").at(1, 1, 2), aov(full, "resampled").at(1, 1, 0));
  EXPECT_GT(aov(full, "resampled").at(1, 1, 0), 0.5F);
}

TEST(GridGather, AFurnaceIsConstant) {
  SceneBuilder builder;
  const glm::vec3 emission(1.0F / std::numbers::pi_v<float>);
  builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F),
                  builder.add_material(lambert(glm::vec3(0.5F), emission)), true);
  builder.look({0.1F, 0.2F, -0.5F}, {0, 0, 1}, 70.0F);
  const Frame frame = gridded(builder.scene, {});
  double sum = 0.0;
  for (const float value : frame.radiance.pixels) {
    EXPECT_NEAR(value, 2.0F / std::numbers::pi_v<float>, 0.08F);
    sum += static_cast<double>(value);
  }
  EXPECT_NEAR(sum / static_cast<double>(frame.radiance.pixels.size()), 2.0 / std::numbers::pi,
              0.015);
}

TEST(GridGather, SameBytesForEveryNumberOfThreads) {
  const SceneBuilder builder = closed_room();
  const Frame one = gridded(builder.scene, {"class_samples=32", "gather_samples=32"}, 1);
  const Frame two = gridded(builder.scene, {"class_samples=32", "gather_samples=32"}, 2);
  EXPECT_EQ(one.radiance.pixels, two.radiance.pixels);
}

TEST(GridGather, ErrorsAreHiddenTogether) {
  EXPECT_EQ(final_gather::largest_hidden({4.0, 3.0}, 5.0), 4.0);
  EXPECT_EQ(final_gather::largest_hidden({4.0, 3.0}, 4.99), 3.0);
  EXPECT_EQ(final_gather::largest_hidden({4.0, 3.0}, 2.99), 0.0);
  EXPECT_EQ(final_gather::largest_hidden({0.0, 0.0}, 0.0), 0.0);
  EXPECT_EQ(final_gather::largest_hidden({}, 1.0), 0.0);

  const SceneBuilder builder = closed_room();
  const final_gather::PerceptionSettings plain{.has_masking = false, .threshold_scale = 3.0};
  const GridScene together(builder.scene, {}, plain);
  const GridScene each(builder.scene, {.judges_together = false}, plain);
  std::size_t more = 0;
  for (std::size_t i = 0; i < each.gather.vertices().size(); ++i) {
    const auto& a = each.gather.vertices()[i].records;
    const auto& b = together.gather.vertices()[i].records;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t r = 0; r < a.size(); ++r) {
      EXPECT_GE(b[r].resamples_visibility, a[r].resamples_visibility);
      EXPECT_GE(b[r].resamples_form_factor, a[r].resamples_form_factor);
      EXPECT_GE(b[r].visibility_samples, a[r].visibility_samples);
      more += b[r].resamples_visibility && !a[r].resamples_visibility ? 1 : 0;
    }
  }
  EXPECT_GT(more, 10U);
}

/// Masking raises thresholds; it only takes senders and samples away.
TEST(GridGather, MaskingOnlyTakesSamplesAway) {
  const SceneBuilder builder = closed_room();
  for (const final_gather::MaskedBy by :
       {final_gather::MaskedBy::all, final_gather::MaskedBy::matched}) {
    const GridScene plain(builder.scene, {}, {.has_masking = false, .masked_by = by});
    const GridScene masked(builder.scene, {}, {.has_masking = true, .masked_by = by});
    ASSERT_EQ(plain.gather.vertices().size(), masked.gather.vertices().size());
    std::size_t fewer = 0;
    for (std::size_t i = 0; i < plain.gather.vertices().size(); ++i) {
      const GatherVertex& a = plain.gather.vertices()[i];
      const GatherVertex& b = masked.gather.vertices()[i];
      EXPECT_GE(b.threshold_cd_m2, a.threshold_cd_m2);
      EXPECT_EQ(a.base_threshold_cd_m2, b.base_threshold_cd_m2);
      if (by == final_gather::MaskedBy::all) {
        EXPECT_EQ(a.threshold_cd_m2, b.base_threshold_cd_m2);
      }
      // Cells of three pixels: what they blur is fine, and less visible than an edge.
      EXPECT_GE(a.threshold_cd_m2, a.base_threshold_cd_m2 * (1.0 - 1e-12));
      ASSERT_EQ(a.records.size(), b.records.size());
      for (std::size_t r = 0; r < a.records.size(); ++r) {
        const SenderRecord& without = a.records[r];
        const SenderRecord& with = b.records[r];
        EXPECT_EQ(without.sender, with.sender);
        EXPECT_EQ(without.visibility, with.visibility);
        EXPECT_LE(with.resamples_visibility, without.resamples_visibility);
        EXPECT_LE(with.resamples_form_factor, without.resamples_form_factor);
        EXPECT_LE(with.visibility_samples, without.visibility_samples * 1.00001F);
        fewer += with.visibility_samples < 0.99F * without.visibility_samples ? 1 : 0;
      }
    }
    EXPECT_GT(fewer, 10U);
  }
}

/// What stands for the pixels around a vertex: the minimum asks for most (Sec. 5.2.1).
TEST(GridGather, PoolingOrdersThresholds) {
  const SceneBuilder builder = closed_room();
  const auto pooled = [&](final_gather::Pooling pooling) {
    return GridScene(builder.scene, {.pooling = pooling}).gather.vertices();
  };
  const auto mean = pooled(final_gather::Pooling::mean);
  const auto quartile = pooled(final_gather::Pooling::quartile);
  const auto minimum = pooled(final_gather::Pooling::minimum);
  std::size_t lower = 0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    EXPECT_LE(minimum[i].threshold_cd_m2, quartile[i].threshold_cd_m2);
    EXPECT_LE(minimum[i].threshold_cd_m2, mean[i].threshold_cd_m2 * (1.0 + 1e-12));
    EXPECT_EQ(minimum[i].weak_share, 0.0);
    lower += minimum[i].threshold_cd_m2 < 0.95 * mean[i].threshold_cd_m2 ? 1 : 0;
  }
  EXPECT_GT(lower, 0U);
}

/// Across the faces of cells, with whatever classes and numbers of samples lie on either side.
TEST(GridGather, HasNoStepsBetweenCellsWhereNothingOccludes) {
  SceneBuilder builder;
  const int floor = builder.add_material(lambert(glm::vec3(0.6F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.2F), glm::vec3(2.0F)));
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, floor);
  builder.add_quad({-0.5F, 1.5F, -0.5F}, {1, 0, 0}, {0, 0, 1}, lamp);
  builder.add_quad({-2, 0, 2}, {0, 2, 0}, {4, 0, 0}, floor);
  builder.look({0, 1.2F, -3}, {0, 0.3F, 0.5F}, 60.0F);
  const GridScene scene(builder.scene, {}, {}, 300);
  const auto light_at = [&](const glm::vec3& place) {
    Receiver receiver;
    receiver.point = scene.rays.point_on_triangle(0, 0, {0.3F, 0.3F});
    receiver.point.position = place;
    receiver.normal = {0, 1, 0};
    return static_cast<double>(scene.gather.at(receiver).irradiance.x);
  };
  const auto& grid = scene.anchors.grid();
  const auto place_at = [](float x) { return glm::vec3(x, 0.0F, 0.11F); };
  const auto is_same_piece = [&](float x, float y) {
    return grid.blend(place_at(x)).vertices == grid.blend(place_at(y)).vertices;
  };
  int faces = 0;
  for (int i = 0; i < 180; ++i) {
    float low = -0.9F + 0.01F * static_cast<float>(i);
    float high = low + 0.01F;
    if (is_same_piece(low, high)) continue;
    ++faces;
    while (high - low > 1e-5F) {  // where the piece ends
      const float middle = 0.5F * (low + high);
      (is_same_piece(low, middle) ? low : high) = middle;
    }
    const double light = light_at(place_at(low));
    EXPECT_NEAR(light, light_at(place_at(high)), 1e-3 * light);
  }
  EXPECT_GE(faces, 5);
  for (int i = 0; i < 200; ++i) {  // every step of a line, faces or not
    const glm::vec3 here(-0.9F + 0.009F * static_cast<float>(i), 0.0F, 0.11F);
    const double light = light_at(here);
    EXPECT_NEAR(light, light_at(here + glm::vec3(2e-5F, 0, 0)), 1e-3 * light);
  }
}

}  // namespace
}  // namespace renderers::test

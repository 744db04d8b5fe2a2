#include "renderers/element_hierarchy/side_views.h"

#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"

/// Light of clusters and sides: no power is lost, and none goes where nothing is seen.
namespace renderers::test {
namespace {

using element_hierarchy::Element;
using element_hierarchy::Link;
using element_hierarchy::LinkSet;
using element_hierarchy::SideViews;

/// Power of an irradiance on all leaves.
double power_w(const SolvedScene& solved, const std::vector<glm::vec3>& irradiance) {
  double sum = 0.0;
  for (std::size_t i = 0; i < solved.elements().size(); ++i) {
    const Element& element = solved.elements()[i];
    if (element.is_leaf()) sum += static_cast<double>(element.area_m2 * irradiance[i].x);
  }
  return sum;
}

/// In a closed room with one link all rays bring what they meet: where all surfaces reflect 1 W/m2,
/// all get as much, and the lamp's light arrives on top of it.
TEST(SideViews, SidesGetWhatTheirRaysMeet) {
  const SceneBuilder builder = closed_room();
  const SolvedScene solved(builder.scene, solver_settings(1));
  const std::vector<Element>& elements = solved.elements();
  std::vector<glm::vec3> emission;
  for (const Element& element : elements) emission.push_back(element.emitted_w_m2);
  std::vector<glm::vec3> radiosity = emission;
  for (glm::vec3& value : radiosity) value += glm::vec3(1.0F);
  std::vector<glm::vec3> of_emission(elements.size());
  std::vector<glm::vec3> of_all(elements.size());
  solved.solution->views->gather(emission, of_emission);
  solved.solution->views->gather(radiosity, of_all);
  int sides = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!elements[i].is_leaf()) continue;
    EXPECT_NEAR(of_all[i].x - of_emission[i].x, 1.0F, 1e-5F);
    ++sides;
  }
  EXPECT_GE(sides, 22);
  // Eight rays per side towards a lamp that is seen whole from nearly everywhere.
  EXPECT_NEAR(power_w(solved, of_emission), power_w(solved, emission),
              0.05 * power_w(solved, emission));
}

/// A box with a lit chamber in a lit room: the chamber sees itself alone, the box's outsides see
/// the room alone. So a cluster of both sends mostly the radiosity of the outsides, more than its
/// mean.
TEST(SideViews, ClustersSendWhatLeavesThem) {
  SceneBuilder builder;
  const int gray = builder.add_material(lambert(glm::vec3(0.5F), glm::vec3(1.0F)));
  builder.add_box(glm::vec3(-4.0F), glm::vec3(4.0F), gray, true);
  const auto box = static_cast<std::uint32_t>(builder.scene.objects.size());
  builder.add_box(glm::vec3(2.0F), glm::vec3(3.0F), gray, false);
  const auto chamber = static_cast<std::uint32_t>(builder.scene.objects.size());
  builder.add_box(glm::vec3(2.05F), glm::vec3(2.95F), gray, true);
  const SolvedScene solved(builder.scene, solver_settings(64));
  const std::vector<Element>& elements = solved.elements();
  std::vector<glm::vec3> radiosity(elements.size(), glm::vec3(0.0F));
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements[i].is_patch && elements[i].object < chamber) radiosity[i] = glm::vec3(1.0F);
  }
  const auto mean = [&](const Element& cluster) {
    float light = 0.0F;
    for (std::uint32_t r = cluster.root_begin; r < cluster.root_end; ++r) {
      const std::uint32_t root = solved.tree().roots()[r];
      light += elements[root].area_m2 * radiosity[root].x;
    }
    return light / cluster.area_m2;
  };
  // All clusters send to the whole.
  std::vector<LinkSet::New> to_all;
  for (std::uint32_t i = 0; i < elements.size(); ++i) {
    if (elements[i].is_patch) continue;
    Link link;
    link.source = i;
    to_all.push_back({0, link});
  }
  LinkSet links;
  links.replace({}, to_all, elements.size());
  solved.solution->views->follow(links);
  SideViews::Sent sent;
  solved.solution->views->send(radiosity, sent);
  int clusters = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements[i].is_patch) {
      EXPECT_EQ(sent.out[i], radiosity[i]);
      continue;
    }
    bool has_room = false;
    bool has_box = false;
    bool has_chamber = false;
    for (std::uint32_t r = elements[i].root_begin; r < elements[i].root_end; ++r) {
      const std::uint32_t object = elements[solved.tree().roots()[r]].object;
      has_room = has_room || object < box;
      has_box = has_box || (object >= box && object < chamber);
      has_chamber = has_chamber || object >= chamber;
    }
    const bool has_several_faces = elements[i].root_end - elements[i].root_begin >= 8;
    if (has_room || !has_box || !has_chamber || !has_several_faces) continue;
    ++clusters;
    EXPECT_GT(sent.out[i].x, mean(elements[i]) + 0.02F);
    EXPECT_LE(sent.out[i].x, 1.0F);
  }
  EXPECT_GE(clusters, 2);
}

/// A few rays of each side say of the room's light what all of them do.
TEST(SideViews, FewRaysPerSideAgreeOnTheWhole) {
  const SceneBuilder builder = closed_room();
  const SolvedScene solved(builder.scene, solver_settings(400));
  const std::vector<glm::vec3>& radiosity = solved.solution->field->radiosity();
  const auto mean_of = [&](std::size_t most_rays) {
    LinkSet links = solved.solution->links;
    solved.solution->views->follow(links, most_rays);
    std::vector<glm::vec3> received(solved.elements().size(), glm::vec3(0.0F));
    solved.solution->views->gather(radiosity, received);
    double sum = 0.0;
    double area_m2 = 0.0;
    for (const std::uint32_t root : solved.tree().roots()) {
      const auto own_m2 = static_cast<double>(solved.tree().at(root).area_m2);
      sum += own_m2 * static_cast<double>(received[root].x);
      area_m2 += own_m2;
    }
    return sum / area_m2;
  };
  const double all = mean_of(std::numeric_limits<std::size_t>::max());
  EXPECT_NEAR(mean_of(32), all, 0.05 * all);
  EXPECT_NE(mean_of(32), all);
}

/// In a closed room all rays from all sides end on sides of the room: the link of the whole to
/// itself lets all through, whatever it was estimated at. Links of patches stay.
TEST(SideViews, LinksLetThroughWhatRaysFollow) {
  const SceneBuilder builder = closed_room();
  const SolvedScene solved(builder.scene, solver_settings(1));
  LinkSet links = solved.solution->links;
  ASSERT_EQ(links.size(), 1U);
  links.of(0).front().form_factor = 0.25F;
  links.of(0).front().visibility = element_hierarchy::share_coded(0.5);
  solved.solution->views->follow(links);
  EXPECT_NEAR(links.all().front().transfer(), 1.0F, 1e-3F);

  // Rays of whole sides say nothing of their parts.
  const SolvedScene fine(builder.scene, solver_settings(400));
  links = fine.solution->links;
  const std::uint16_t half = element_hierarchy::share_coded(0.5);
  for (std::uint32_t i = 0; i < fine.elements().size(); ++i) {
    for (Link& link : links.of(i)) link.visibility = half;
  }
  fine.solution->views->follow(links);
  int patches = 0;
  for (auto i = static_cast<std::uint32_t>(fine.solution->views->first_part());
       i < fine.elements().size(); ++i) {
    for (const Link& link : std::as_const(links).of(i)) {
      EXPECT_EQ(link.visibility, half);
      ++patches;
    }
  }
  EXPECT_GT(patches, 100);
}

/// A floor lamp under a lid: the lid's underside shares a cluster with its upper side, which sees
/// the dark half of the room alone.
TEST(SideViews, SidesThatLookAwayFromTheLampStayDarker) {
  SceneBuilder builder;
  const int gray = builder.add_material(lambert(glm::vec3(0.1F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.1F), glm::vec3(1.0F)));
  builder.add_box(glm::vec3(-2.0F), glm::vec3(2.0F), gray, true);
  const int lid = static_cast<int>(builder.scene.objects.size());
  builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, gray);
  builder.add_quad({-1, -1.5F, -1}, {0, 0, 2}, {2, 0, 0}, lamp);
  element_hierarchy::SolverSettings settings = solver_settings(64);
  double ratio[2] = {};
  for (const int i : {0, 1}) {
    settings.shares_by_views = i == 1;
    const SolvedScene solved(builder.scene, settings);
    double up = 0.0;
    double down = 0.0;
    for (std::size_t e = 0; e < solved.elements().size(); ++e) {
      const Element& element = solved.elements()[e];
      if (!element.is_leaf() || static_cast<int>(element.object) != lid) continue;
      const auto light =
          static_cast<double>(element.area_m2 * solved.solution->field->irradiance()[e].x);
      (element.normal.y > 0.0F ? up : down) += light;
    }
    ratio[i] = up / down;
  }
  EXPECT_LT(ratio[1], ratio[0]);
  EXPECT_LT(ratio[1], 0.2);
}

/// A sheet that shines on one side: from there it has all of its radiosity, from behind none, from
/// its edge what others say.
TEST(DirectedRadiosity, ASheetSendsWhatLooksThatWay) {
  element_hierarchy::DirectedRadiosity sheet;
  sheet.add({0, 0, -1}, 2.0F, glm::vec3(10.0F));
  sheet.add({0, 0, 1}, 2.0F, glm::vec3(0.0F));
  const glm::vec3 otherwise(3.0F);
  EXPECT_EQ(sheet.at({0.3F, 0.2F, -5.0F}, otherwise).x, 10.0F);
  EXPECT_EQ(sheet.at({0.3F, 0.2F, 5.0F}, otherwise).x, 0.0F);
  EXPECT_EQ(sheet.at({1, 0, 0}, otherwise).x, 3.0F);
  // A floor beside it counts as far as it looks that way.
  sheet.add({0, 1, 0}, 4.0F, glm::vec3(1.0F));
  EXPECT_NEAR(sheet.at({0, 1, -1}, otherwise).x, (2.0F * 10.0F + 4.0F * 1.0F) / 6.0F, 1e-5F);
}

/// A lamp with a dark back before a wall, seen by a room through its cluster: with few links as
/// with many its light arrives. A mean over front and back would send half of it.
TEST(SideViews, ALampInAClusterSendsAllOfItsLight) {
  SceneBuilder builder;
  const int wall = builder.add_material(lambert(glm::vec3(0.6F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(20.0F)));
  builder.add_box({-3, 0, -3}, {3, 3, 3}, wall, true);
  for (int i = 0; i < 8; ++i) {
    const float x = -2.1F + 0.6F * static_cast<float>(i);
    builder.add_box({x, 0, 0.86F}, {x + 0.12F, 0.95F, 0.9F}, wall, false);
  }
  builder.add_quad({-0.4F, 1.6F, 2.95F}, {0, 0.4F, 0}, {0.8F, 0, 0}, lamp);
  builder.add_quad({-0.4F, 1.6F, 2.96F}, {0.8F, 0, 0}, {0, 0.4F, 0}, wall);
  double emitted_w = 0.0;
  const auto arriving_w = [&](bool shares_by_views) {
    element_hierarchy::SolverSettings settings = solver_settings(3000);
    settings.shares_by_views = shares_by_views;
    settings.refinement.splits_near_sources = shares_by_views;
    const SolvedScene solved(builder.scene, settings);
    std::vector<glm::vec3> emission(solved.elements().size());
    for (std::size_t i = 0; i < emission.size(); ++i)
      emission[i] = solved.elements()[i].emitted_w_m2;
    emitted_w = power_w(solved, emission);
    return power_w(solved, solved.solution->emitted_irradiance);
  };
  const double by_views = arriving_w(true);
  EXPECT_NEAR(by_views, emitted_w, 0.03 * emitted_w);
  EXPECT_LT(arriving_w(false), 0.9 * emitted_w);
}

}  // namespace
}  // namespace renderers::test

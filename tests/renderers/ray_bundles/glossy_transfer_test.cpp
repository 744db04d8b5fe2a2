#include "renderers/ray_bundles/glossy_transfer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"
#include "tests/renderers/ggx_oracle.h"
#include "tests/renderers/ray_bundles/bundle_fixture.h"

/// Lobes that send light on: Hermes et al. 2010, Sec. 5.3 and 5.4.
namespace renderers::test {
namespace {

using ray_bundles::DirectionKind;
using Random = std::mt19937_64;

constexpr float kExponent = 2.0F;
constexpr double kLobeAlbedo = 0.5;

double uniform(Random& random) { return std::uniform_real_distribution<double>()(random); }

/// Mean light that arrives in the closed unit cube whose walls emit 1 and reflect by lobes alone:
/// random walks over the hemispheres, of the cube and the lobe alone, nothing of bundles.
double mean_incident_by_walks(int walks) {
  Random random(7);
  double sum = 0.0;
  for (int walk = 0; walk < walks; ++walk) {
    // A uniform point of the face z = 0 and light along a cosine-weighted direction: all faces are
    // alike. `out` is where the light goes, from the next point's view.
    glm::dvec3 at(uniform(random), uniform(random), 0.0);
    glm::dvec3 normal(0.0, 0.0, 1.0);
    const double r = std::sqrt(uniform(random));
    const double azimuth = 2.0 * std::numbers::pi * uniform(random);
    glm::dvec3 to_light(r * std::cos(azimuth), r * std::sin(azimuth), std::sqrt(1.0 - r * r));
    double weight = 1.0;
    for (int bounce = 0; bounce < 40; ++bounce) {
      // To the wall that the direction meets.
      double t = 1e9;
      glm::length_t axis = 0;
      for (glm::length_t i = 0; i < 3; ++i) {
        if (to_light[i] == 0.0) continue;
        const double wall = to_light[i] > 0.0 ? 1.0 : 0.0;
        const double distance = (wall - at[i]) / to_light[i];
        if (distance > 1e-12 && distance < t) {
          t = distance;
          axis = i;
        }
      }
      at += t * to_light;
      normal = glm::dvec3(0.0);
      normal[axis] = to_light[axis] > 0.0 ? -1.0 : 1.0;
      at[axis] = normal[axis] < 0.0 ? 1.0 : 0.0;
      sum += weight;
      // Its lobe towards where we come from, lit from a uniform direction: 2 pi f cos.
      const glm::dvec3 out = -to_light;
      const double z = uniform(random);
      const double turn = 2.0 * std::numbers::pi * uniform(random);
      const double flat = std::sqrt(1.0 - z * z);
      glm::dvec3 drawn(0.0);
      drawn[axis] = z * normal[axis];
      drawn[(axis + 1) % 3] = flat * std::cos(turn);
      drawn[(axis + 2) % 3] = flat * std::sin(turn);
      const glm::dvec3 mirror = 2.0 * glm::dot(normal, out) * normal - out;
      const double cos_alpha = glm::dot(mirror, drawn);
      if (cos_alpha <= 0.0) break;
      const double n = static_cast<double>(kExponent);
      weight *= kLobeAlbedo * (n + 2.0) * std::pow(cos_alpha, n) * z;
      to_light = drawn;
    }
  }
  return sum / walks;
}

double mean_incident_by_bundles(DirectionKind directions, std::int64_t count) {
  SceneBuilder builder;
  scene::Material material = phong(glm::vec3(0.0F), glm::vec3(kLobeAlbedo), kExponent);
  material.emission = glm::vec3(1.0F);
  add_closed_box(builder, glm::vec3(0.0F), glm::vec3(1.0F), builder.add_material(material), true);
  BundleScene built(builder.scene, 32);
  ray_bundles::TransportSettings settings;
  settings.directions = directions;
  settings.lines_across = 32;
  settings.solution.glossy_chain = true;
  settings.solution.has_back_sides = false;
  settings.solution.restarts_output = false;
  const ray_bundles::BundleTransport transport = transported(built, settings, count);
  return light_on(built, transport.solution(), LightOf::both).mean.x;
}

/// Independent directions make every path, Halton points in their order do not: each is a function
/// of the one before ("all combinations of paths appear", Sec. 5.4, holds for the former).
TEST(GlossyTransfer, ChainsGlossyPathsIfDirectionsAreIndependent) {
  const double expected = mean_incident_by_walks(200'000);
  EXPECT_GT(expected, 1.5);  // of it, 1 is emission
  EXPECT_NEAR(mean_incident_by_bundles(DirectionKind::iid, 3072), expected, 0.03 * expected);
  EXPECT_NEAR(mean_incident_by_bundles(DirectionKind::halton_permuted, 3072), expected,
              0.03 * expected);
  EXPECT_LT(mean_incident_by_bundles(DirectionKind::halton, 3072), 0.95 * expected);
}

/// A room of Lambert walls, seen in a glossy plate that is lit by another one behind the camera.
SceneBuilder room_of_plates() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(12.0F)));
  const int plate = builder.add_material(phong(glm::vec3(0.1F), glm::vec3(0.5F), 2.0F));
  add_closed_box(builder, glm::vec3(-1.0F), glm::vec3(1.0F), white, true);
  builder.add_quad({-0.8F, -0.8F, 0.9F}, {0, 1.6F, 0}, {1.6F, 0, 0}, plate);
  builder.add_quad({0.8F, -0.8F, -0.9F}, {0, 1.6F, 0}, {-1.6F, 0, 0}, plate);
  builder.add_quad({-0.2F, 0.98F, 0.3F}, {0.4F, 0, 0}, {0, 0, 0.4F}, lamp);
  builder.add_point_light({0.5F, -0.2F, 0.0F}, glm::vec3(0.3F));
  builder.look({0.1F, 0.1F, -0.5F}, {0, -0.1F, 1}, 70.0F);
  return builder;
}

Frame picture(const SceneBuilder& builder, std::string renderer, std::vector<std::string> settings,
              std::int64_t samples) {
  return render(builder.scene, {.renderer = std::move(renderer),
                                .settings = std::move(settings),
                                .width_px = 16,
                                .height_px = 16,
                                .samples = samples});
}

/// All of the light, however the last lobe and the direct light come by it; without the chain a
/// share is missing that is many times the tolerance.
TEST(GlossyTransfer, PicturesHaveThePathTracersMean) {
  const SceneBuilder builder = room_of_plates();
  const double expected =
      mean_of(aov(picture(builder, "path", {"transport=full"}, 256), "indirect"));
  const std::vector<std::string> sizes{"atlas_side=32", "lines=32", "pass_directions=256"};
  const auto indirect_of = [&](std::vector<std::string> settings) {
    settings.insert(settings.end(), sizes.begin(), sizes.end());
    return mean_of(aov(picture(builder, "ray-bundles", settings, 2048), "indirect"));
  };
  // Directions are common to all pixels, and so is their noise: 3 to 4 % of the mean.
  EXPECT_NEAR(indirect_of({"glossy=chain"}), expected, 0.08 * expected);
  EXPECT_NEAR(indirect_of({"glossy=chain", "final_glossy=bundles", "direct=bundles"}), expected,
              0.08 * expected);
  EXPECT_LT(indirect_of({}), 0.85 * expected);
}

/// Directional albedo of a lobe: the integral of f cos over the hemisphere, by the midpoints of a
/// fine grid. @param cosine  of the view
double directional_albedo(double rho, double n, double cosine) {
  constexpr int kRows = 400;
  constexpr int kColumns = 800;
  const glm::dvec3 mirror(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
  double sum = 0.0;
  for (int row = 0; row < kRows; ++row) {
    const double z = (row + 0.5) / kRows;
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = 2.0 * std::numbers::pi * (column + 0.5) / kColumns;
      const double flat = std::sqrt(1.0 - z * z);
      const double cos_alpha =
          glm::dot(mirror, glm::dvec3(flat * std::cos(azimuth), flat * std::sin(azimuth), z));
      if (cos_alpha > 0.0) sum += rho * (n + 2.0) * std::pow(cos_alpha, n) * z;
    }
  }
  return sum / (kRows * kColumns);
}

/// A glossy plate in white light from everywhere has the radiance of its directional albedo,
/// whichever way its lobe finds the light.
TEST(GlossyTransfer, APlateInWhiteLightHasItsDirectionalAlbedo) {
  EXPECT_NEAR(directional_albedo(0.7, 10.0, 1.0), 0.7, 1e-4);
  for (const float exponent : {2.0F, 10.0F, 50.0F}) {
    for (const double cosine : {0.95, 0.5, 0.25}) {
      SceneBuilder builder;
      builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0},
                       builder.add_material(phong(glm::vec3(0.0F), glm::vec3(0.7F), exponent)));
      builder.set_environment(glm::vec3(1.0F));
      const auto height = static_cast<float>(20.0 * cosine);
      const auto aside = static_cast<float>(20.0 * std::sqrt(1.0 - cosine * cosine));
      builder.look({aside, height, 0.0F}, {0, 0, 0}, 0.5F);
      const double expected = directional_albedo(0.7, static_cast<double>(exponent), cosine);
      for (const char* glossy : {"final_glossy=bundles", "final_glossy=ray"}) {
        const Frame frame = picture(
            builder, "ray-bundles",
            {glossy, "direct=bundles", "atlas_side=32", "lines=32", "camera_rays=32"}, 2048);
        // 2048 directions meet a sharp lobe seldom.
        const double tolerance = exponent > 10.0F ? 0.05 : 0.01;
        EXPECT_NEAR(mean_of(frame.radiance), expected, tolerance * expected)
            << glossy << " " << exponent << " " << cosine;
      }
    }
  }
}

/// Integral of f cos of GGX over the hemisphere, by rows of equal z.
double directional_albedo_of_ggx(double rho, double alpha, double cosine) {
  constexpr int kRows = 600;
  constexpr int kColumns = 1200;
  const glm::dvec3 normal(0.0, 0.0, 1.0);
  const glm::dvec3 out(-std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
  double sum = 0.0;
  for (int row = 0; row < kRows; ++row) {
    const double z = (row + 0.5) / kRows;
    const double flat = std::sqrt(1.0 - z * z);
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = 2.0 * std::numbers::pi * (column + 0.5) / kColumns;
      const glm::dvec3 in(flat * std::cos(azimuth), flat * std::sin(azimuth), z);
      sum += rho * test::ggx_value(alpha, normal, out, in) * z;
    }
  }
  return sum * 2.0 * std::numbers::pi / (kRows * kColumns);
}

TEST(GlossyTransfer, APlateOfMicrofacetsInWhiteLightHasItsDirectionalAlbedo) {
  for (const float alpha : {0.8F, 0.3F, 0.1F}) {
    for (const double cosine : {0.95, 0.5}) {
      SceneBuilder builder;
      builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0},
                       builder.add_material(ggx(glm::vec3(0.0F), glm::vec3(0.7F), alpha)));
      builder.set_environment(glm::vec3(1.0F));
      const auto height = static_cast<float>(20.0 * cosine);
      const auto aside = static_cast<float>(20.0 * std::sqrt(1.0 - cosine * cosine));
      builder.look({aside, height, 0.0F}, {0, 0, 0}, 0.5F);
      const double expected = directional_albedo_of_ggx(0.7, static_cast<double>(alpha), cosine);
      for (const char* glossy : {"final_glossy=bundles", "final_glossy=ray"}) {
        const Frame frame = picture(
            builder, "ray-bundles",
            {glossy, "direct=bundles", "atlas_side=32", "lines=32", "camera_rays=32"}, 2048);
        const double tolerance = alpha < 0.2F ? 0.05 : 0.01;
        EXPECT_NEAR(mean_of(frame.radiance), expected, tolerance * expected)
            << glossy << " " << alpha << " " << cosine;
      }
    }
  }
}

TEST(GlossyTransfer, ClaimsWhatItHolds) {
  const RendererInfo& info = find_renderer("ray-bundles", {});
  const scene::Scene scene;
  const auto transport = [&](std::vector<std::string> settings) {
    return info.claims(parameters_of("ray-bundles", settings), scene).transport;
  };
  EXPECT_EQ(transport({}), Transport::diffuse);
  EXPECT_EQ(transport({"final_glossy=bundles"}), Transport::diffuse);
  EXPECT_EQ(transport({"glossy=chain"}), Transport::full);
}

TEST(GlossyTransfer, RefusesLobesBetweenDirections) {
  const SceneBuilder builder = room_of_plates();
  const auto error_of = [&](const std::vector<std::string>& settings) {
    return tests::input_error_of([&] { picture(builder, "ray-bundles", settings, 4); });
  };
  EXPECT_EQ(error_of({"glossy=chain", "most_exponent=1"}),
            "ray-bundles: material \"\" has a lobe of exponent 2; accepted: at most 1 "
            "(most_exponent): sharper lobes fall between directions; or glossy last_surface with "
            "final_glossy ray");
  EXPECT_EQ(error_of({"most_exponent=1", "atlas_side=32"}), "no error");
  SceneBuilder facets = room_of_plates();
  for (scene::Material& material : facets.scene.materials) {
    if (material.is_glossy()) material = ggx(glm::vec3(0.0F), glm::vec3(0.5F), 0.03125F);
  }
  EXPECT_EQ(
      tests::input_error_of([&] { picture(facets, "ray-bundles", {"glossy=chain"}, 4); }),
      "ray-bundles: material \"\" has a lobe of alpha 0.03125, as sharp as exponent 510; accepted: "
      "at most 200 (most_exponent): sharper lobes fall between directions; or glossy last_surface "
      "with final_glossy ray");
  EXPECT_EQ(error_of({"glossy=chain", "feed=jacobi"}),
            "ray-bundles: glossy chain with feed jacobi; what lobes send belongs to no bounce: "
            "take another feed, or glossy last_surface");
}

}  // namespace
}  // namespace renderers::test

// Filtered maps against means in double precision, and what they take of memory.
#include "renderers/clustered_visibility/convolution_maps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "renderers/clustered_visibility/light_clusters.h"
#include "renderers/shadow_maps/hard_maps.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::clustered_visibility {
namespace {

constexpr int kSide_px = 32;

/// Two area lights above a floor with a box, the second one without lights, a third one aslant.
std::vector<AreaLight> three_area_lights() {
  AreaLight up;
  up.position = {0.1F, 2.0F, 0.2F, 1.0F};
  up.axis = {0.0F, -1.0F, 0.0F, 0.0F};
  up.shape = {0.3F, kFarDepth / 5.0F, 0.09F, 4.0F};
  AreaLight aslant = up;
  aslant.axis = {0.6F, -0.8F, 0.0F, 0.0F};
  return {up, AreaLight{}, aslant};
}

class ConvolutionMapsGl : public test::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    test::SceneBuilder builder;
    const int white = builder.add_material(test::lambert(glm::vec3(0.5F)));
    builder.add_quad({-2.0F, 0.0F, -2.0F}, {0.0F, 0.0F, 4.0F}, {4.0F, 0.0F, 0.0F}, white);
    builder.add_box({-0.5F, 0.0F, -0.5F}, {0.3F, 1.0F, 0.4F}, white, false);
    scene_ = builder.scene;
    opengl::GpuScene on_device(context());
    StageTimer timer;
    on_device.load(scene_, timer);
    lights_ = opengl::Buffer::of<AreaLight>(context(), three_area_lights());
    maps_ = std::make_unique<shadow_maps::HemisphereMaps>(context(), kSide_px, 3);
    shadow_maps::HardMaps(context()).fill(*maps_, on_device, {&lights_, kAreaLightStride}, 0, 3);
  }

  /// Depths of a layer as the series takes them.
  std::vector<double> depths(int layer) const {
    const double scale = double{three_area_lights()[static_cast<std::size_t>(layer)].shape.y};
    std::vector<double> z;
    for (const std::uint32_t word : maps_->distances().read_words(layer)) {
      z.push_back(std::min(double{std::bit_cast<float>(word)} * scale, double{kFarDepth}));
    }
    return z;
  }

  scene::Scene scene_;
  opengl::Buffer lights_;
  std::unique_ptr<shadow_maps::HemisphereMaps> maps_;
};

/// Mean over a level's texel of a function of depth.
template <typename Function>
double mean_over(const std::vector<double>& z, int level, int x, int y, Function function) {
  const int side = 1 << level;
  double sum = 0.0;
  for (int j = y * side; j < (y + 1) * side; ++j) {
    for (int i = x * side; i < (x + 1) * side; ++i) {
      sum += function(z[static_cast<std::size_t>(j * kSide_px + i)]);
    }
  }
  return sum / (side * side);
}

struct Quantity {
  const opengl::Texture* texture;
  double (*of)(double z, double frequency);
};

std::vector<Quantity> quantities_of(const ConvolutionMaps& maps) {
  return {{&maps.sines(), [](double z, double c) { return std::sin(c * z); }},
          {&maps.cosines(), [](double z, double c) { return std::cos(c * z); }},
          {&maps.weighted_sines(), [](double z, double c) { return z * std::sin(c * z); }},
          {&maps.weighted_cosines(), [](double z, double c) { return z * std::cos(c * z); }}};
}

/// Greatest difference of a rounded value from the number, and one of the arithmetic's.
double rounding_of(const opengl::Texture& texture) {
  constexpr double kArithmetic = 2e-5;  // of the device's sines
  const auto format = texture.shape().format;
  if (format == opengl::TextureFormat::rgba8_snorm) return 0.5 / 127.0 + kArithmetic;
  // Drivers may cut 16-bit numbers off instead of rounding them.
  return format == opengl::TextureFormat::rgba32f ? kArithmetic : 0x1p-11 + kArithmetic;
}

TEST_F(ConvolutionMapsGl, EveryLevelIsTheMeanOfAllItsTexelsRoundedOnce) {
  for (const auto& [terms, format] :
       {std::pair{4, BasisFormat::bits_8}, {2, BasisFormat::bits_16}, {9, BasisFormat::bits_32}}) {
    ConvolutionMaps maps(context(), kSide_px, 3, {.terms = terms, .format = format});
    maps.make(*maps_, lights_);
    const int groups = (terms + 3) / 4;
    for (const int layer : {0, 2}) {
      const std::vector<double> z = depths(layer);
      for (const Quantity& quantity : quantities_of(maps)) {
        for (int level = 0; level < maps.levels(); ++level) {
          const int side = kSide_px >> level;
          for (int k = 1; k <= terms; ++k) {
            const auto texels = quantity.texture->read(level, layer * groups + (k - 1) / 4);
            const double c = std::numbers::pi * (2 * k - 1);
            double worst = 0.0;
            for (int i = 0; i < side * side; ++i) {
              const double mean = mean_over(z, level, i % side, i / side,
                                            [&](double each) { return quantity.of(each, c); });
              worst = std::max(
                  worst,
                  std::abs(double{texels[static_cast<std::size_t>(i * 4 + (k - 1) % 4)]} - mean));
            }
            EXPECT_LE(worst, rounding_of(*quantity.texture)) << level << " " << k;
          }
        }
      }
    }
  }
}

TEST_F(ConvolutionMapsGl, DepthsAreAveragedToo) {
  ConvolutionMaps maps(context(), kSide_px, 3, {.terms = 4});
  maps.make(*maps_, lights_);
  const std::vector<double> z = depths(2);
  const auto whole = maps.depths().read(maps.levels() - 1, 2);
  EXPECT_NEAR(double{whole.front()},
              mean_over(z, maps.levels() - 1, 0, 0, [](double each) { return each; }), 0x1p-11);
}

TEST_F(ConvolutionMapsGl, TablesAreSumsOfFixedPointNumbers) {
  ConvolutionMaps maps(context(), kSide_px, 3, {.terms = 3, .prefilter = Prefilter::sat});
  maps.make(*maps_, lights_);
  EXPECT_EQ(maps.table_scale(), 32768);
  const std::vector<double> z = depths(0);
  const std::vector<std::uint32_t> words = maps.sines().read_words(0);
  for (int k = 1; k <= 3; ++k) {
    const double c = std::numbers::pi * (2 * k - 1);
    for (const int corner : {0, 5, kSide_px - 1}) {
      double sum = 0.0;
      for (int y = 0; y <= corner; ++y) {
        for (int x = 0; x <= corner; ++x) {
          sum += std::sin(c * z[static_cast<std::size_t>(y * kSide_px + x)]);
        }
      }
      const auto word = words[static_cast<std::size_t>((corner * kSide_px + corner) * 4 + k - 1)];
      const int texels = (corner + 1) * (corner + 1);
      EXPECT_NEAR(static_cast<double>(std::bit_cast<std::int32_t>(word)) / 32768.0, sum,
                  texels * (0.5 / 32768.0 + 2e-5));
    }
  }
}

TEST_F(ConvolutionMapsGl, TablesOfLargerMapsHaveCoarserSteps) {
  EXPECT_EQ(ConvolutionMaps(context(), 512, 1, {.prefilter = Prefilter::sat}).table_scale(), 8192);
}

TEST_F(ConvolutionMapsGl, ThirtyLayersOfThePapersTakeSixtyEightMegabytes) {
  const ConvolutionMaps maps(context(), 256, 30, {.terms = 4});
  // Dong et al. 2009, Sec. 6: 4 terms of 8 bit, the same of 16 bit times depth, and depth.
  EXPECT_NEAR(static_cast<double>(maps.layer_bytes()), 68e6, 0.1 * 68e6);
}

TEST_F(ConvolutionMapsGl, MoreLayersThanTheDeviceHasAreUnsupported) {
  EXPECT_THROW(ConvolutionMaps(context(), 16, 1024, {.terms = 16}), UnsupportedError);
}

}  // namespace
}  // namespace renderers::clustered_visibility

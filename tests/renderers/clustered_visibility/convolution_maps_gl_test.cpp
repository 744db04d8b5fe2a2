#include "renderers/clustered_visibility/convolution_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "renderers/contract/devices.h"
#include "tests/renderers/clustered_visibility/convolution_oracle.h"
#include "tests/renderers/clustered_visibility/depth_bench.h"
#include "tests/renderers/many_lights/gl_fixture.h"

namespace test_clustered_visibility {
namespace {

using renderers::opengl::TextureFormat;

class ConvolutionMapsTest : public renderers::test::GlTest {
 protected:
  DepthBench bench(const DepthLayers& layers) const { return DepthBench(context(), layers); }
};
class ConvolutionMapsTerms : public ConvolutionMapsTest, public testing::WithParamInterface<int> {};

constexpr double kStepOf8Bits = 1.0 / 127.0;
constexpr double kMostDrift = 1e-3;  ///< of levels of 8 bits

/// Half a step of a format at a value; a whole one of half floats, which llvmpipe cuts off.
double rounding_of(TextureFormat format, double value) {
  switch (format) {
    case TextureFormat::rgba8_snorm:
      return 0.5 * kStepOf8Bits;
    case TextureFormat::rgba16f:
    case TextureFormat::r16f:
      return 0x1p-10 * std::fabs(value) + 0x1p-24;
    default:
      return 0.0;
  }
}

/// Of the angle c_k z in single precision, and of the sine.
double float_error(int k) { return 1e-6 + 2e-7 * series_frequency(k); }

struct Errors {
  double excess = 0.0;  ///< greatest error beyond what rounding explains
  double drift = 0.0;   ///< greatest mean error, with sign, of a level of at least 64 texels
};

/// @param k       of the basis that the values are of
/// @param format  that they are stored in
void add_values(const std::vector<double>& values, const std::vector<double>& expected, int k,
                TextureFormat format, Errors& errors) {
  ASSERT_EQ(values.size(), expected.size());
  double drift = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double error = values[i] - expected[i];
    drift += error / static_cast<double>(values.size());
    const double allowed = rounding_of(format, expected[i]) + float_error(k);
    errors.excess = std::max(errors.excess, std::fabs(error) - allowed);
  }
  if (values.size() >= 64) errors.drift = std::max(errors.drift, std::fabs(drift));
}

void add_level(const cv::ConvolutionMaps& maps, Quantity quantity, int k, int layer, int level,
               const DepthMap& map, Errors& errors) {
  add_values(read_level(maps, quantity, k, layer, level), level_means(map, quantity, k, level), k,
             texture_of(maps, quantity).shape().format, errors);
}

Errors errors_of(const cv::ConvolutionMaps& maps, Quantity quantity, const DepthLayers& layers) {
  Errors errors;
  const int terms = quantity == Quantity::depth ? 1 : maps.settings().terms;
  for (int layer = 0; layer < layers.layers(); ++layer) {
    const DepthMap map = depths_of(layers, layer);
    for (int k = 1; k <= terms; ++k) {
      for (int level = 0; level < maps.levels(); ++level) {
        add_level(maps, quantity, k, layer, level, map, errors);
      }
    }
  }
  return errors;
}

TEST_P(ConvolutionMapsTerms, EveryLevelIsRoundedOnce) {
  const DepthLayers layers = blocks_on_slopes(32, 2);
  const auto maps = bench(layers).convolution_maps({.terms = GetParam()});
  EXPECT_EQ(maps.levels(), 6);
  for (const Quantity quantity : kQuantities) {
    const Errors errors = errors_of(maps, quantity, layers);
    EXPECT_LE(errors.excess, 0.0) << static_cast<int>(quantity);
    EXPECT_LT(errors.drift, kMostDrift) << static_cast<int>(quantity);
    if (quantity == Quantity::depth) continue;
    for (int k = GetParam() + 1; k <= (GetParam() + 3) / 4 * 4; ++k) {
      const auto values = read_level(maps, quantity, k, 0, 1);
      EXPECT_EQ(values, std::vector<double>(values.size(), 0.0)) << "beyond the last term";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(K, ConvolutionMapsTerms, testing::Values(1, 2, 4, 5, 8, 16));

class ConvolutionMapsFormats : public ConvolutionMapsTest,
                               public testing::WithParamInterface<cv::BasisFormat> {};

TEST_P(ConvolutionMapsFormats, EveryLevelIsRoundedOnce) {
  const bool is_single = GetParam() == cv::BasisFormat::bits_32;
  const DepthLayers layers = blocks_on_slopes(32, 2);
  const auto maps = bench(layers).convolution_maps({.terms = 4, .format = GetParam()});
  EXPECT_EQ(maps.sines().shape().format,
            is_single ? TextureFormat::rgba32f : TextureFormat::rgba16f);
  for (const Quantity quantity : kQuantities) {
    const Errors errors = errors_of(maps, quantity, layers);
    EXPECT_LE(errors.excess, 0.0) << static_cast<int>(quantity);
    EXPECT_LT(errors.drift, is_single ? 1e-6 : 3e-4) << static_cast<int>(quantity);
  }
}

INSTANTIATE_TEST_SUITE_P(Bits, ConvolutionMapsFormats,
                         testing::Values(cv::BasisFormat::bits_16, cv::BasisFormat::bits_32));

TEST_F(ConvolutionMapsTest, LevelsOfRoundedLevelsWouldFailTheSameBound) {
  const DepthMap map = depths_of(blocks_on_slopes(32, 1), 0);
  auto below = level_means(map, Quantity::sine, 2, 0);
  double excess = 0.0;
  for (int level = 0; level < 6; ++level) {
    const int side = 32 >> level;
    const auto expected = level_means(map, Quantity::sine, 2, level);
    std::vector<double> rounded(expected.size(), 0.0);
    for (int i = 0; i < side * side; ++i) {
      const auto own = static_cast<std::size_t>(i);
      const auto corner = static_cast<std::size_t>(i / side * 4 * side + i % side * 2);
      const auto row = static_cast<std::size_t>(2 * side);
      const double mean = level == 0 ? below[own]
                                     : 0.25 * (below[corner] + below[corner + 1] +
                                               below[corner + row] + below[corner + row + 1]);
      rounded[own] = std::round(mean / kStepOf8Bits) * kStepOf8Bits;
      excess = std::max(excess, std::fabs(rounded[own] - expected[own]) - 0.5 * kStepOf8Bits);
    }
    below = rounded;
  }
  EXPECT_GT(excess, 0.2 * kStepOf8Bits);
}

/// The level above one of unsigned bytes as glGenerateTextureMipmap makes it of RGBA8 on Mesa's
/// software driver (22.3.6; all 8 levels of a map of 256 random bytes a side are the same to the
/// bit): along x, then along y, the mean of two, its half rounded up.
std::vector<int> next_level_of_bytes(const std::vector<int>& bytes, int side) {
  const auto mean = [](int a, int b) { return (a + b + 1) / 2; };
  std::vector<int> next;
  for (int y = 0; y < side; y += 2) {
    for (int x = 0; x < side; x += 2) {
      const int* const upper = &bytes[static_cast<std::size_t>(y * side + x)];
      const int* const lower = upper + side;
      next.push_back(mean(mean(upper[0], upper[1]), mean(lower[0], lower[1])));
    }
  }
  return next;
}

TEST_F(ConvolutionMapsTest, LevelsOfUnsignedBytesByTheDriverDriftBeyondTheBound) {
  constexpr double kStep = 2.0 / 255.0;  // of [-1, 1] in unsigned bytes
  const DepthMap map = depths_of(blocks_on_slopes(64, 1), 0);
  std::vector<int> bytes;
  for (const double value : level_means(map, Quantity::sine, 2, 0)) {
    bytes.push_back(static_cast<int>(std::lround((value + 1.0) / kStep)));
  }
  for (int level = 0; level <= 3; ++level) {
    if (level > 0) bytes = next_level_of_bytes(bytes, 64 >> (level - 1));
    std::vector<double> values;
    for (const int byte : bytes) values.push_back(byte * kStep - 1.0);
    Errors errors;
    add_values(values, level_means(map, Quantity::sine, 2, level), 2, TextureFormat::rgba8_snorm,
               errors);
    // A quarter of a step up for each of a level's two means.
    EXPECT_NEAR(errors.drift, 0.5 * level * kStep, 0.15 * kStep) << level;
    EXPECT_EQ(errors.drift > kMostDrift, level > 0) << level;
    EXPECT_EQ(errors.excess > 0.0, level > 0) << level;
  }
}

TEST_F(ConvolutionMapsTest, EightBitsCostLittleInTheStep) {
  const DepthLayers layers = blocks_on_slopes(16, 1);
  const DepthMap map = depths_of(layers, 0);
  for (const int terms : {4, 8}) {
    const auto maps = bench(layers).convolution_maps({.terms = terms});
    std::vector<std::vector<double>> sines;
    std::vector<std::vector<double>> cosines;
    for (int k = 1; k <= terms; ++k) {
      sines.push_back(read_level(maps, Quantity::sine, k, 0, 0));
      cosines.push_back(read_level(maps, Quantity::cosine, k, 0, 0));
    }
    const ConvolutionSeries series{terms, 0.5};
    double greatest = 0.0;
    double squares = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < map.z.size(); ++i) {
      BasisMeans stored;
      for (std::size_t k = 0; k < sines.size(); ++k) {
        stored.sine.push_back(sines[k][i]);
        stored.cosine.push_back(cosines[k][i]);
      }
      for (double d = 0.0; d <= 0.9; d += 0.03) {
        const double error = filtered_step(series, stored, d) - series_step(series, map.z[i] - d);
        greatest = std::max(greatest, std::fabs(error));
        squares += error * error;
        ++count;
      }
    }
    EXPECT_LT(greatest, 0.005) << terms;
    EXPECT_LT(std::sqrt(squares / count), 0.0016) << terms;
    EXPECT_GT(greatest, 0.001) << "8 bits must show, or these are others";
  }
}

class ConvolutionMapsPrefilters : public ConvolutionMapsTest,
                                  public testing::WithParamInterface<cv::Prefilter> {};

TEST_P(ConvolutionMapsPrefilters, LeaveEmptyLayersAlone) {
  DepthLayers layers = blocks_on_slopes(16, 3);
  DepthBench device = bench(layers);
  auto maps = device.convolution_maps({.terms = 5, .prefilter = GetParam()});
  // All quantities of a layer, of every level.
  const auto texels = [&](int layer) {
    std::vector<float> all;
    for (const Quantity quantity : kQuantities) {
      const auto& texture = texture_of(maps, quantity);
      const int groups = quantity == Quantity::depth ? 1 : 2;
      for (int target = layer * groups; target < (layer + 1) * groups; ++target) {
        for (int level = 0; GetParam() == cv::Prefilter::mip && level < maps.levels(); ++level) {
          const auto values = texture.read(level, target);
          all.insert(all.end(), values.begin(), values.end());
        }
        if (GetParam() == cv::Prefilter::mip) continue;
        for (const std::uint32_t word : texture.read_words(target)) {
          all.push_back(static_cast<float>(word));
        }
      }
    }
    return all;
  };
  const std::vector<std::vector<float>> before{texels(0), texels(1), texels(2)};
  for (auto& layer : layers.distances_m) {
    for (float& distance_m : layer) distance_m *= 0.7F;
  }
  layers.area_lights[1].position.w = 0.0F;
  layers.area_lights[1].shape.y = 0.1F;
  device.write(layers);
  device.make(maps);
  EXPECT_TRUE(texels(0) != before[0]);
  EXPECT_TRUE(texels(1) == before[1]);
  EXPECT_TRUE(texels(2) != before[2]);
}

INSTANTIATE_TEST_SUITE_P(MipAndSat, ConvolutionMapsPrefilters,
                         testing::Values(cv::Prefilter::mip, cv::Prefilter::sat));

TEST_F(ConvolutionMapsTest, BytesOfTheLayers) {
  const cv::ConvolutionMaps maps(context(), 256, 30, {.terms = 4});
  constexpr std::int64_t kTexels = 30 * ((1 << 18) - 1) / 3;  // of all levels
  // Sines and cosines 4 bytes each, times depth 8 each, depth 2.
  EXPECT_EQ(maps.layer_bytes(), kTexels * (2 * 4 + 2 * 8 + 2));
  EXPECT_NEAR(static_cast<double>(maps.layer_bytes()), 68e6, 1e6);
  EXPECT_GT(maps.memory_bytes(), maps.layer_bytes()) << "sums of the levels";
  const cv::ConvolutionMaps tables(context(), 64, 3, {.terms = 5, .prefilter = cv::Prefilter::sat});
  EXPECT_EQ(tables.layer_bytes(), std::int64_t{64 * 64 * 3} * 16 * (4 * 2 + 1));
}

TEST_F(ConvolutionMapsTest, SayWhatTheDeviceAllows) {
  const auto limits = context()->limits();
  const auto message_of = [&](std::int64_t size_px, std::int64_t layers) -> std::string {
    try {
      const cv::ConvolutionMaps maps(context(), static_cast<int>(size_px), static_cast<int>(layers),
                                     {.terms = 5});
    } catch (const renderers::UnsupportedError& error) {
      return error.what();
    }
    return "";
  };
  const auto name = context()->facts().renderer;
  const auto size_px = std::int64_t{1}
                       << std::bit_width(static_cast<std::uint64_t>(limits.texture_size_px));
  EXPECT_EQ(message_of(size_px, 1),
            fmt::format("a texture of {0} x {0}, 2 layers is needed; {1} allows {2} a side",
                        size_px, name, limits.texture_size_px));
  const std::int64_t layers = limits.array_layers / 2 + 1;
  EXPECT_EQ(message_of(4, layers),
            fmt::format("a texture of 4 x 4, {} layers is needed; {} allows {} layers", 2 * layers,
                        name, limits.array_layers))
      << "two texture layers each for five terms";
  EXPECT_EQ(message_of(4, 2), "");
}

}  // namespace
}  // namespace test_clustered_visibility

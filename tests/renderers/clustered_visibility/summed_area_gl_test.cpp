#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "renderers/clustered_visibility/convolution_maps.h"
#include "renderers/clustered_visibility/shader_files.h"
#include "renderers/opengl/program.h"
#include "tests/renderers/clustered_visibility/convolution_oracle.h"
#include "tests/renderers/clustered_visibility/depth_bench.h"
#include "tests/renderers/many_lights/gl_fixture.h"

/// Summed-area tables of convolution maps, and means over boxes from them.
namespace test_clustered_visibility {
namespace {

namespace opengl = renderers::opengl;

constexpr const char* kBoxPath = "boxes.comp.glsl";
constexpr const char* kBoxText = R"(
#include "renderers/clustered_visibility/shaders/table_mean.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 3) readonly buffer Boxes { vec4 boxes[]; };
layout(std430, binding = 4) writeonly buffer Means { vec4 means[]; };
layout(binding = 0) uniform isampler2DArray table;
uniform int box_count;
void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i < box_count) means[i] = box_mean(table, boxes[i].xy, boxes[i].z, int(boxes[i].w));
}
)";

class SummedAreaTest : public renderers::test::GlTest {
 protected:
  cv::ConvolutionMaps tables(const DepthLayers& layers, int terms) const {
    return DepthBench(context(), layers)
        .convolution_maps({.terms = terms, .prefilter = cv::Prefilter::sat});
  }
  /// box_mean of shaders/table_mean.glsl. @param boxes  centre, width, layer of the texture
  std::vector<glm::vec4> box_means(const cv::ConvolutionMaps& maps, Quantity quantity,
                                   const std::vector<glm::vec4>& boxes) const {
    const auto kit = cv::shader_files();
    std::vector<opengl::ShaderFile> files(kit.begin(), kit.end());
    files.push_back({kBoxPath, kBoxText});
    opengl::Program program(
        *context(), {files, {kBoxPath}, {{"TABLE_SCALE", std::to_string(maps.table_scale())}}});
    const auto buffer = opengl::Buffer::of(context(), std::span<const glm::vec4>(boxes));
    const opengl::Buffer means(context(), boxes.size() * sizeof(glm::vec4));
    program.storage(3, buffer);
    program.storage(4, means);
    program.sampler(0, texture_of(maps, quantity));
    program.set("box_count", static_cast<int>(boxes.size()));
    program.set("table_corners", 16);
    program.dispatch(opengl::groups_for(static_cast<std::int64_t>(boxes.size()), 64));
    return means.read<glm::vec4>(boxes.size());
  }
};

/// A table of one term of one layer, with zeros before its first row and column.
class Table {
 public:
  Table(const cv::ConvolutionMaps& maps, Quantity quantity, int k, int layer) {
    const bool is_depth = quantity == Quantity::depth;
    const int groups = is_depth ? 1 : (maps.settings().terms + 3) / 4;
    const auto& texture = texture_of(maps, quantity);
    side_ = texture.shape().width_px;
    const auto words = texture.read_words(layer * groups + (k - 1) / 4);
    for (std::size_t i = static_cast<std::size_t>((k - 1) % 4); i < words.size(); i += 4) {
      sums_.push_back(words[i]);
    }
  }
  int side() const { return side_; }
  /// Sum over texels [x0, x1) x [y0, y1), modulo 2^32, in [-2^31, 2^31).
  std::int64_t box(int x0, int y0, int x1, int y1) const {
    return static_cast<std::int32_t>(at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0));
  }

 private:
  std::uint32_t at(int x, int y) const {
    return x == 0 || y == 0 ? 0U : sums_[static_cast<std::size_t>((y - 1) * side_ + x - 1)];
  }
  int side_ = 0;
  std::vector<std::uint32_t> sums_;
};

TEST_F(SummedAreaTest, TexelsAreTheBasisInFixedPoint) {
  const DepthLayers layers = blocks_on_slopes(32, 2);
  const auto maps = tables(layers, 5);
  EXPECT_EQ(maps.table_scale(), 1 << 15);
  for (const Quantity quantity : kQuantities) {
    for (const int k : {1, 4, 5}) {
      if (quantity == Quantity::depth && k > 1) continue;
      const DepthMap map = depths_of(layers, 1);
      const Table table(maps, quantity, k, 1);
      for (int i = 0; i < 32 * 32; ++i) {
        const int x = i % 32;
        const int y = i / 32;
        const double expected = 32768.0 * value_of(quantity, k, map.z[static_cast<std::size_t>(i)]);
        EXPECT_NEAR(static_cast<double>(table.box(x, y, x + 1, y + 1)), expected, 0.7)
            << static_cast<int>(quantity) << " " << k << " " << x << " " << y;
      }
    }
  }
}

TEST_F(SummedAreaTest, SumsOfBoxesAreExact) {
  const DepthLayers layers = blocks_on_slopes(64, 1);
  const auto maps = tables(layers, 2);
  renderers::test::Numbers numbers;
  const auto corner = [&](int low) { return low + static_cast<int>(numbers.next() * (65 - low)); };
  for (const Quantity quantity : kQuantities) {
    const Table table(maps, quantity, 1, 0);
    for (int i = 0; i < 40; ++i) {
      const int x0 = corner(0);
      const int y0 = corner(0);
      const int x1 = corner(x0);
      const int y1 = corner(y0);
      std::int64_t sum = 0;
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) sum += table.box(x, y, x + 1, y + 1);
      }
      EXPECT_EQ(table.box(x0, y0, x1, y1), sum) << x0 << " " << y0 << " " << x1 << " " << y1;
    }
  }
}

TEST_F(SummedAreaTest, BoxMeansAtAnyPositionAreTheOracles) {
  const DepthLayers layers = blocks_on_slopes(64, 2);
  const auto maps = tables(layers, 2);
  renderers::test::Numbers numbers;
  std::vector<glm::vec4> boxes{{0.5F, 0.5F, 1.0F, 1.0F},
                               {0.0F, 0.0F, 0.1F, 1.0F},
                               {1.0F, 1.0F, 0.1F, 1.0F},
                               {1.0F, 0.5F, 1.0F, 1.0F}};
  for (int i = 0; i < 100; ++i) {
    const double x = numbers.next();
    const double y = numbers.next();
    boxes.emplace_back(x, y, numbers.between(1.0 / 64.0, 0.5), 1.0);
  }
  const auto sines = box_means(maps, Quantity::weighted_sine, boxes);
  const auto depths = box_means(maps, Quantity::depth, boxes);
  const DepthMap map = depths_of(layers, 1);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Kernel kernel = box_kernel(map, glm::dvec2(boxes[i].x, boxes[i].y), boxes[i].z);
    const BasisMeans expected = basis_means({2, 0.0}, kernel);
    EXPECT_NEAR(sines[i].x, expected.z_sine[0], 1e-4) << i;
    EXPECT_NEAR(sines[i].y, expected.z_sine[1], 1e-4) << i;
    EXPECT_NEAR(depths[i].x, expected.z, 1e-4) << i;
  }
}

TEST_F(SummedAreaTest, BoxesNarrowerThanATexelAreAsWideAsOne) {
  const DepthLayers layers = blocks_on_slopes(64, 1);
  const auto maps = tables(layers, 2);
  const auto means = box_means(maps, Quantity::depth, {{10.5F / 64.0F, 7.5F / 64.0F, 0.0F, 0.0F}});
  EXPECT_NEAR(means[0].x, depths_of(layers, 0).z[7 * 64 + 10], 5e-5);
}

TEST_F(SummedAreaTest, MeanOfAWholeMapOfOnes) {
  // Nothing anywhere: depth 0.9, where the third sine is sin(4.5 pi) = 1 in every texel.
  for (const int size_px : {128, 256}) {
    DepthLayers layers = blocks_on_slopes(size_px, 1);
    for (float& distance_m : layers.distances_m[0]) {
      distance_m = std::numeric_limits<float>::infinity();
    }
    const auto maps = tables(layers, 4);
    EXPECT_GE(maps.table_scale(), 32767);
    const auto means =
        box_means(maps, Quantity::sine, {{0.5F, 0.5F, 1.0F, 0.0F}, {0.501F, 0.5F, 1.0F, 0.0F}});
    for (const glm::vec4& mean : means) {
      EXPECT_NEAR(mean.z, 1.0F, 1e-4F) << size_px;
      EXPECT_NEAR(mean.x, std::sin(series_frequency(1) * 0.9), 1e-4) << size_px;
    }
  }
}

TEST_F(SummedAreaTest, NoSumExceeds32Bits) {
  for (const int size_px : {4, 128, 256, 512}) {
    const cv::ConvolutionMaps maps(context(), size_px, 1, {.prefilter = cv::Prefilter::sat});
    const std::int64_t texels = std::int64_t{size_px} * size_px;
    EXPECT_LT(texels * maps.table_scale(), std::int64_t{1} << 31) << size_px;
    EXPECT_GT((texels + 1) * (maps.table_scale() + 1),
              std::min(std::int64_t{1} << 31, texels << 15))
        << "as fine as it can be";
  }
}

}  // namespace
}  // namespace test_clustered_visibility

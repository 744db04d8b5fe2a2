#include "tests/renderers/clustered_visibility/depth_bench.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "renderers/clustered_visibility/shader_files.h"
#include "renderers/opengl/program.h"
#include "renderers/opengl/shader_source.h"
#include "tests/renderers/many_lights/gl_fixture.h"

namespace test_clustered_visibility {

namespace opengl = renderers::opengl;

namespace {

constexpr const char* kWritePath = "write_distances.comp.glsl";
constexpr const char* kWriteText = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 3) readonly buffer Distances { uint distances[]; };
layout(r32ui, binding = 0) writeonly uniform uimage2DArray image;
void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  ivec3 size = imageSize(image);
  if (any(greaterThanEqual(texel, size))) return;
  imageStore(image, texel, uvec4(distances[(texel.z * size.y + texel.y) * size.x + texel.x]));
}
)";

}  // namespace

DepthLayers blocks_on_slopes(int size_px, int layers) {
  renderers::test::Numbers numbers;
  DepthLayers result{size_px, {}, {}};
  constexpr int kBlock_px = 3;
  const int blocks = size_px / kBlock_px + 1;
  for (int layer = 0; layer < layers; ++layer) {
    const double range_m = 2.0 + layer;
    std::vector<double> heights;
    for (int i = 0; i < blocks * blocks; ++i) heights.push_back(numbers.between(-1.0, 1.2));
    std::vector<float> distances_m;
    for (int y = 0; y < size_px; ++y) {
      for (int x = 0; x < size_px; ++x) {
        const double slope = 0.5 + 0.4 * (x + 0.3 * y) / size_px;
        const double block =
            heights[static_cast<std::size_t>(y / kBlock_px * blocks + x / kBlock_px)];
        const double share = block > 0.0 ? std::min(slope, block) : slope;
        const bool is_free = numbers.next() < 1.0 / 6.0;
        distances_m.push_back(is_free ? std::numeric_limits<float>::infinity()
                                      : static_cast<float>(range_m * share));
      }
    }
    cv::AreaLight area;
    area.position.w = 1.0F;
    area.shape.y = static_cast<float>(0.9 / range_m);
    result.distances_m.push_back(std::move(distances_m));
    result.area_lights.push_back(area);
  }
  return result;
}

DepthBench::DepthBench(std::shared_ptr<opengl::Context> context, const DepthLayers& layers)
    : context_(std::move(context)),
      maps_(context_, layers.size_px, layers.layers()),
      area_lights_(context_, layers.area_lights.size() * sizeof(cv::AreaLight)) {
  write(layers);
}

void DepthBench::write(const DepthLayers& layers) {
  std::vector<float> all_m;
  for (const auto& layer : layers.distances_m)
    all_m.insert(all_m.end(), layer.begin(), layer.end());
  const auto buffer = opengl::Buffer::of(context_, std::span<const float>(all_m));
  const std::vector<opengl::ShaderFile> files{{kWritePath, kWriteText}};
  opengl::Program program(*context_, {files, {kWritePath}, {}});
  program.storage(3, buffer);
  program.image(0, maps_.distances(), opengl::Access::write);
  const std::uint32_t groups = opengl::groups_for(layers.size_px, 8);
  program.dispatch(groups, groups, static_cast<std::uint32_t>(layers.layers()));
  area_lights_.write(std::span<const cv::AreaLight>(layers.area_lights));
}

cv::ConvolutionMaps DepthBench::convolution_maps(const cv::ConvolutionSettings& settings) const {
  cv::ConvolutionMaps maps(context_, maps_.size_px(), maps_.layers(), settings);
  make(maps);
  return maps;
}

cv::MomentMaps DepthBench::moment_maps() const {
  cv::MomentMaps maps(context_, maps_.size_px(), maps_.layers());
  maps.make(maps_, area_lights_);
  return maps;
}

float DepthBench::answer(const cv::AreaVisibilitySettings& settings, const cv::AreaShadows& shadows,
                         float receiver_depth, const opengl::ShaderFile& shader) const {
  const auto kit = cv::shader_files();
  std::vector<opengl::ShaderFile> files(kit.begin(), kit.end());
  files.push_back(shader);
  opengl::Program program(
      *context_,
      {files, {std::string(shader.path)}, cv::area_visibility_defines(settings, shadows.filtered)});
  cv::bind_area_visibility(program, settings, shadows);
  const opengl::Buffer results(context_, sizeof(float));
  program.storage(4, results);
  program.set("receiver_depth", receiver_depth);
  program.dispatch(1);
  return results.read<float>(1).front();
}

DepthMap depths_of(const DepthLayers& layers, int layer) {
  const auto own = static_cast<std::size_t>(layer);
  DepthMap map{layers.size_px, {}};
  for (const float distance_m : layers.distances_m[own]) {
    const float z = distance_m * layers.area_lights[own].shape.y;
    map.z.push_back(static_cast<double>(std::min(z, 0.9F)));
  }
  return map;
}

const opengl::Texture& texture_of(const cv::ConvolutionMaps& maps, Quantity quantity) {
  switch (quantity) {
    case Quantity::sine:
      return maps.sines();
    case Quantity::cosine:
      return maps.cosines();
    case Quantity::weighted_sine:
      return maps.weighted_sines();
    case Quantity::weighted_cosine:
      return maps.weighted_cosines();
    default:
      return maps.depths();
  }
}

double value_of(Quantity quantity, int k, double z) {
  const double angle = series_frequency(k) * z;
  switch (quantity) {
    case Quantity::sine:
      return std::sin(angle);
    case Quantity::cosine:
      return std::cos(angle);
    case Quantity::weighted_sine:
      return z * std::sin(angle);
    case Quantity::weighted_cosine:
      return z * std::cos(angle);
    default:
      return z;
  }
}

std::vector<double> level_means(const DepthMap& map, Quantity quantity, int k, int level) {
  const int side = map.size_px >> level;
  std::vector<double> means(static_cast<std::size_t>(side * side), 0.0);
  for (int y = 0; y < map.size_px; ++y) {
    for (int x = 0; x < map.size_px; ++x) {
      const double z = map.z[static_cast<std::size_t>(y * map.size_px + x)];
      means[static_cast<std::size_t>((y >> level) * side + (x >> level))] +=
          std::ldexp(value_of(quantity, k, z), -2 * level);
    }
  }
  return means;
}

std::vector<double> read_level(const cv::ConvolutionMaps& maps, Quantity quantity, int k, int layer,
                               int level) {
  const bool is_depth = quantity == Quantity::depth;
  const int groups = is_depth ? 1 : (maps.settings().terms + 3) / 4;
  const int channels = is_depth ? 1 : 4;
  const int target = layer * groups + (k - 1) / 4;
  const auto texels = texture_of(maps, quantity).read(level, target);
  std::vector<double> values;
  for (std::size_t i = is_depth ? 0U : static_cast<std::size_t>((k - 1) % 4); i < texels.size();
       i += static_cast<std::size_t>(channels)) {
    values.push_back(static_cast<double>(texels[i]));
  }
  return values;
}

}  // namespace test_clustered_visibility

#include "renderers/ray_bundles/gpu_exchange.h"

#include <cassert>
#include <utility>

#include <fmt/core.h>
#include <glm/vec4.hpp>

#include "renderers/opengl/program.h"
#include "renderers/ray_bundles/device_needs.h"
#include "renderers/ray_bundles/gpu_dispatch.h"

namespace renderers::ray_bundles {

namespace {

constexpr std::uint32_t kAll = 0xffffffffU;

/// std430, shaders/receive_light.comp.glsl, as the others here.
struct TexelRecord {
  glm::vec4 normal;
  glm::vec4 shading;
};

struct SumsRecord {
  glm::vec3 light[2];
  float weight;
};

struct CountsRecord {
  std::uint32_t receivers;
  std::uint32_t pairs;
  std::uint32_t lit_pairs;
  std::uint32_t pairs_high;
  std::uint32_t lit_pairs_high;
  std::uint32_t cut_off;
};

std::vector<TexelRecord> records_of(std::span<const ExchangeTexel> texels) {
  std::vector<TexelRecord> records;
  records.reserve(texels.size());
  for (const ExchangeTexel& texel : texels) {
    records.push_back({{texel.geometric_normal, texel.area_m2}, {texel.shading_normal, 0.0F}});
  }
  return records;
}

std::vector<SumsRecord> records_of(const LightSolution::Sums& sums) {
  std::vector<SumsRecord> records;
  records.reserve(sums.weight.size());
  for (std::size_t i = 0; i < sums.weight.size(); ++i) {
    records.push_back({{sums.light[2 * i], sums.light[2 * i + 1]}, sums.weight[i]});
  }
  return records;
}

std::uint64_t of_words(std::uint32_t low, std::uint32_t high) {
  return (std::uint64_t{high} << 32U) + low;
}

/// What a buffer holds. @param begin  first direction
LightSolution::Sums sums_of(const opengl::Buffer& buffer, std::size_t texels, std::int64_t begin) {
  LightSolution::Sums sums;
  sums.reset(texels, begin);
  const std::vector<SumsRecord> records = buffer.read<SumsRecord>(texels);
  for (std::size_t i = 0; i < texels; ++i) {
    sums.light[2 * i] = records[i].light[0];
    sums.light[2 * i + 1] = records[i].light[1];
    sums.weight[i] = records[i].weight;
  }
  return sums;
}

/// @throws UnsupportedError if the device has too few storage blocks, or the largest buffer does
///   not fit one
void require_blocks(const opengl::Context& context, std::size_t texels) {
  const std::string lack = lacking(kExchangeNeeds, context.limits(), context.facts().renderer);
  if (!lack.empty()) {
    throw UnsupportedError("ray-bundles: " + lack + "; accepted: exchange cpu");
  }
  const auto limit_bytes = static_cast<std::size_t>(context.limits().storage_block_bytes);
  if (texels * sizeof(TexelRecord) <= limit_bytes) return;
  throw UnsupportedError(fmt::format(
      "ray-bundles: {} texels take {} bytes; {} allows a storage block {}; accepted: exchange cpu, "
      "or a smaller atlas_side",
      texels, texels * sizeof(TexelRecord), context.facts().renderer, limit_bytes));
}

/// A value for every side. @param value_of  of a side
template <typename ValueOf>
std::vector<glm::vec3> of_sides(std::size_t texels, const ValueOf& value_of) {
  std::vector<glm::vec3> values;
  values.reserve(2 * texels);
  for (std::uint32_t side = 0; side < 2 * texels; ++side) values.push_back(value_of(side));
  return values;
}

}  // namespace

GpuExchange::GpuExchange(std::shared_ptr<opengl::Context> context,
                         std::span<const ExchangeTexel> texels, std::span<const glm::vec3> albedos,
                         const LightSolution& solution)
    : context_(std::move(context)),
      texel_count_(texels.size()),
      window_begin_(solution.received().window.begin),
      texel_counts_(context_, texels.size() * sizeof(std::uint32_t)),
      prefix_sum_(context_) {
  assert(!texels.empty() && albedos.size() == texels.size());
  require_blocks(*context_, texels.size());
  const LightSolution::Received& received = solution.received();
  texels_ = opengl::Buffer::of<TexelRecord>(context_, records_of(texels));
  albedos_ = opengl::Buffer::of<glm::vec3>(context_, albedos);
  known_ = opengl::Buffer::of<glm::vec3>(context_, solution.known_direct());
  if (solution.brings_emission()) {
    emitted_ = opengl::Buffer(context_, 2 * texel_count_ * sizeof(glm::vec3));
    set_emitted(solution);
  }
  const std::vector<glm::vec3> sent =
      of_sides(texel_count_, [&](std::uint32_t side) { return solution.reflected(side); });
  sent_ = opengl::Buffer::of<glm::vec3>(context_, sent);
  next_sent_ = opengl::Buffer::of<glm::vec3>(context_, sent);
  feed_ = opengl::Buffer::of<glm::vec3>(context_, received.feed);
  direct_ = opengl::Buffer::of<SumsRecord>(context_, records_of(received.direct));
  window_ = opengl::Buffer::of<SumsRecord>(context_, records_of(received.window));
  older_ = opengl::Buffer::of<SumsRecord>(context_, records_of(received.older));
  counts_ = opengl::Buffer(context_, texel_count_ * sizeof(CountsRecord));
  counts_.fill(0);
}

void GpuExchange::set_emitted(const LightSolution& solution) {
  emitted_.write<glm::vec3>(
      of_sides(texel_count_, [&](std::uint32_t side) { return solution.emitted(side); }));
}

/// The output's windows move on as `LightSolution::begin_window` does.
void GpuExchange::begin_window(const LightSolution& solution) {
  const std::int64_t begin = solution.received().window.begin;
  if (begin == window_begin_) return;
  window_begin_ = begin;
  std::swap(window_, older_);
  window_.fill(0);
}

void GpuExchange::run_over_lines(const char* pass, const GpuBundleLists& lists,
                                 std::uint32_t line_count) {
  opengl::Program& program = compute_program(*context_, pass);
  program.storage(0, lists.starts());
  program.storage(1, lists.counts());
  program.storage(2, lists.nodes());
  program.storage(3, links_);
  program.storage(4, texel_counts_);
  if (texel_nodes_.id() != 0) {
    program.storage(5, texel_starts_);
    program.storage(6, texel_nodes_);
  }
  program.set("line_count", line_count);
  dispatch_items(program, line_count);
}

std::uint64_t GpuExchange::exchange(const GpuBundleLists& lists, const BundleFrame& frame,
                                    const EndLight& ends, float weight,
                                    const LightSolution& solution) {
  begin_window(solution);
  const std::size_t crossings = std::max(1U, lists.crossings());
  const auto line_count = static_cast<std::uint32_t>(frame.line_count());
  links_.reserve(context_, crossings * sizeof(glm::uvec2));
  texel_counts_.fill(0);
  run_over_lines("link_lines", lists, line_count);
  const CountTotals totals =
      prefix_sum_.run(texel_counts_, static_cast<std::int64_t>(texel_count_), kAll, texel_starts_);
  texel_nodes_.reserve(context_, crossings * sizeof(std::uint32_t));
  run_over_lines("place_links", lists, line_count);
  receive(frame, ends, weight, solution);
  std::swap(sent_, next_sent_);
  context_->check("exchanging the light of a bundle");
  return totals.sum;
}

void GpuExchange::receive(const BundleFrame& frame, const EndLight& ends, float weight,
                          const LightSolution& solution) {
  const SolutionSettings& settings = solution.settings();
  opengl::Defines defines;
  if (solution.brings_emission()) defines.emplace_back("EMISSION", "1");
  if (settings.feed == FeedKind::running_mean) defines.emplace_back("RUNNING_MEAN", "1");
  if (settings.normalisation == Normalisation::self) defines.emplace_back("SELF", "1");
  opengl::Program& program = compute_program(*context_, "receive_light", std::move(defines));
  const opengl::Buffer* buffers[] = {&texels_, &links_,   &texel_starts_, &texel_nodes_, &albedos_,
                                     &known_,  &emitted_, &sent_,         &next_sent_,   &feed_,
                                     &direct_, &window_,  &counts_};
  for (std::uint32_t binding = 0; binding < std::size(buffers); ++binding) {
    if (buffers[binding]->id() != 0) program.storage(binding, *buffers[binding]);
  }
  const std::int64_t directions = solution.directions();
  program.set("texel_count", static_cast<std::uint32_t>(texel_count_));
  program.set("direction", frame.direction);
  program.set("pixel_area_m2", frame.pixel_area_m2());
  program.set("direction_weight", weight);
  program.set("directions", static_cast<float>(directions + 1));
  program.set("step_count", static_cast<float>(directions - settings.direct_only + 1));
  program.set("step_k", static_cast<float>(settings.step_k));
  program.set("light_ahead", ends.ahead);
  program.set("light_behind", ends.behind);
  set_loop_probe(program);
  program.set("has_back_sides", settings.has_back_sides ? 1 : 0);
  dispatch_items(program, static_cast<std::int64_t>(texel_count_));
}

void GpuExchange::fetch(LightSolution& solution) const {
  const LightSolution::Received& before = solution.received();
  LightSolution::Received received;
  received.direct = sums_of(direct_, texel_count_, before.direct.begin);
  received.window = sums_of(window_, texel_count_, before.window.begin);
  received.older = sums_of(older_, texel_count_, before.older.begin);
  received.feed = feed_.read<glm::vec3>(2 * texel_count_);
  solution.set_received(std::move(received), sent_.read<glm::vec3>(2 * texel_count_));
}

ExchangeCounts GpuExchange::counts() const {
  ExchangeCounts total;
  std::size_t cut_off = 0;
  for (const CountsRecord& texel : counts_.read<CountsRecord>(texel_count_)) {
    total.receivers += texel.receivers;
    total.pairs += of_words(texel.pairs, texel.pairs_high);
    total.lit_pairs += of_words(texel.lit_pairs, texel.lit_pairs_high);
    cut_off += texel.cut_off > 0 ? 1 : 0;
  }
  if (cut_off > 0) {
    throw UnsupportedError(
        fmt::format("ray-bundles: {} ends loops before {} of {} texels have all light of their "
                    "lines; accepted: "
                    "exchange cpu, fewer lines, or a larger atlas_side",
                    context_->facts().renderer, cut_off, texel_count_));
  }
  return total;
}

std::int64_t GpuExchange::memory_bytes() const {
  std::size_t bytes = 0;
  for (const opengl::Buffer* buffer :
       {&texels_, &albedos_, &known_, &emitted_, &sent_, &next_sent_, &feed_, &direct_, &window_,
        &older_, &counts_, &links_, &texel_counts_, &texel_starts_, &texel_nodes_}) {
    bytes += buffer->size_bytes();
  }
  return static_cast<std::int64_t>(bytes);
}

}  // namespace renderers::ray_bundles

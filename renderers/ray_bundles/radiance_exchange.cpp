#include "renderers/ray_bundles/radiance_exchange.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"

namespace renderers::ray_bundles {

namespace {

constexpr float kLeastCosine = 0.02F;

/// How a texel lies to a bundle.
struct Attitude {
  Attitude(const ExchangeTexel& texel, const glm::vec3& direction)
      : geometric(glm::dot(texel.geometric_normal, direction)),
        shading(glm::dot(texel.shading_normal, direction)) {}

  bool looks_back() const { return geometric < 0.0F; }  ///< the front
  /// The cosine of the shading normal where it looks to the same side as the surface, else 0: there
  /// nothing is reflected.
  float lit_cosine() const { return std::max(0.0F, looks_back() ? -shading : shading); }

  float geometric;  ///< n . w
  float shading;
};

void add_end(std::uint32_t end, const EndLight& ends, TexelSample::SideLight& sum) {
  sum.emitted += end == kAhead ? ends.ahead : ends.behind;
}

void add_light(const SentLight& light, TexelSample::SideLight& sum, ExchangeCounts& counts) {
  constexpr glm::vec3 kBlack(0.0F);
  sum.emitted += light.emitted;
  sum.reflected += light.reflected;
  counts.pairs += 1;
  counts.lit_pairs += light.reflected != kBlack || light.emitted != kBlack ? 1 : 0;
}

/// By the means of a sender's texel; most are such, and only what is needed is fetched.
void add_mean_light(std::uint32_t side, const LightSolution& solution, TexelSample::SideLight& sum,
                    ExchangeCounts& counts) {
  constexpr glm::vec3 kBlack(0.0F);
  const glm::vec3& reflected = solution.reflected(side);
  bool is_lit = reflected != kBlack;
  sum.reflected += reflected;
  if (solution.brings_emission()) {
    const glm::vec3 emitted = solution.emitted(side);
    is_lit = is_lit || emitted != kBlack;
    sum.emitted += emitted;
  }
  counts.pairs += 1;
  counts.lit_pairs += is_lit ? 1 : 0;
}

SentLight mean_light(std::uint32_t side, const LightSolution& solution) {
  return {solution.emitted(side), solution.reflected(side), solution.reflected_diffuse(side)};
}

SentLight detailed_light(std::uint32_t side, const PointColors& colors,
                         const LightSolution& solution) {
  SentLight light = mean_light(side, solution);
  if (solution.brings_emission() && side % 2 == 0) light.emitted = colors.emission;
  const glm::vec3 diffuse = colors.albedo_ratio * light.reflected_diffuse;
  light.reflected += diffuse - light.reflected_diffuse;
  light.reflected_diffuse = diffuse;
  return light;
}

/// Of a sender that is not its texel's mean, along the bundle's lines.
std::optional<PointColors> colors_at(std::uint32_t texel, const glm::vec3& position,
                                     const Bundle& bundle) {
  auto colors = bundle.detail->at(texel, position);
  if (colors && bundle.directed != nullptr) colors->emission *= bundle.directed->factor(texel);
  return colors;
}

/// Adds a sender's light to a side's sums.
void add_sender(const Sender& sender, const glm::ivec2& line_px, const Bundle& bundle,
                const LightSolution& solution, TexelSample::SideLight& sum,
                ExchangeCounts& counts) {
  if (is_end(sender.side)) {
    add_end(sender.side, bundle.ends, sum);
  } else {
    add_light(light_of(sender, line_px, bundle, solution), sum, counts);
  }
}

void scale(float factor, TexelSample& sample) {
  for (TexelSample::SideLight& side : sample.sides) {
    side.emitted *= factor;
    side.reflected *= factor;
  }
}

/// Index of the node that is the texel, or the nearest one that can stand in for it.
/// @param depth_m  where the texel's plane meets the line
/// @param slack_m  how far from there a node of the same attitude may stand in
std::optional<std::size_t> find_self(std::span<const ListNode> line, std::uint32_t near_side,
                                     float depth_m, float slack_m) {
  std::optional<std::size_t> stand_in;
  float nearest_m = slack_m;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i].near_side == near_side) return i;
    const bool same_way = ((line[i].near_side ^ near_side) & 1U) == 0;
    const float distance_m = std::fabs(line[i].depth_m - depth_m);
    if (!same_way || distance_m > nearest_m) continue;
    nearest_m = distance_m;
    stand_in = i;
  }
  return stand_in;
}

std::optional<Partners> partners_of(const ExchangeTexel& texel, std::uint32_t near_side,
                                    const Attitude& attitude, const Bundle& bundle) {
  const BundleFrame& frame = bundle.frame;
  const BundlePoint place = frame.project(texel.position);
  // How the depth of the texel's plane grows along the raster, and how far a bent surface may be
  // from that plane: a share of a pixel times its slope, and roundings.
  const glm::vec3& normal = texel.geometric_normal;
  const glm::vec2 slope =
      -glm::vec2(glm::dot(normal, frame.axis_x), glm::dot(normal, frame.axis_y)) /
      attitude.geometric;
  constexpr float kShareOfPixel = 0.5F;
  constexpr float kShareOfRadius = 1e-5F;
  const float slack_m =
      kShareOfPixel * frame.pixel_m * glm::length(slope) + kShareOfRadius * frame.sphere_radius_m;

  const glm::ivec2 pixel(place.place_px);
  const glm::vec2 off_center = place.place_px - glm::vec2(pixel) - 0.5F;
  const glm::ivec2 step(off_center.x < 0.0F ? -1 : 1, off_center.y < 0.0F ? -1 : 1);
  const bool x_is_nearer = std::fabs(off_center.x) > std::fabs(off_center.y);
  const std::array<glm::ivec2, 4> tried{
      pixel, pixel + (x_is_nearer ? glm::ivec2(step.x, 0) : glm::ivec2(0, step.y)),
      pixel + (x_is_nearer ? glm::ivec2(0, step.y) : glm::ivec2(step.x, 0)), pixel + step};
  for (const glm::ivec2& at : tried) {
    if (at.x < 0 || at.y < 0 || at.x >= frame.width_px || at.y >= frame.height_px) continue;
    const glm::vec2 offset_m = (glm::vec2(at) + 0.5F - place.place_px) * frame.pixel_m;
    const std::span<const ListNode> line = bundle.lists.line(at.x, at.y);
    const auto own = find_self(line, near_side, place.depth_m + glm::dot(slope, offset_m), slack_m);
    if (!own) continue;
    Partners partners;
    partners.line_px = at;
    if (*own > 0) partners.before = {far_side(line[*own - 1]), line[*own - 1].depth_m};
    if (*own + 1 < line.size()) {
      partners.after = {line[*own + 1].near_side, line[*own + 1].depth_m};
    }
    return partners;
  }
  return std::nullopt;
}

/// Counts of all threads.
struct SharedCounts {
  std::atomic<std::uint64_t> receivers = 0;
  std::atomic<std::uint64_t> pairs = 0;
  std::atomic<std::uint64_t> lit_pairs = 0;
  std::atomic<std::uint64_t> unmatched = 0;

  void add(const ExchangeCounts& counts) {
    receivers.fetch_add(counts.receivers, std::memory_order_relaxed);
    pairs.fetch_add(counts.pairs, std::memory_order_relaxed);
    lit_pairs.fetch_add(counts.lit_pairs, std::memory_order_relaxed);
    unmatched.fetch_add(counts.unmatched, std::memory_order_relaxed);
  }
  ExchangeCounts total() const { return {receivers, pairs, lit_pairs, unmatched}; }
};

/// What one texel gathers; weight 0 if the bundle misses it.
TexelSample gather_texel(const ExchangeTexel& texel, std::uint32_t index, const Bundle& bundle,
                         const LightSolution& solution, ExchangeCounts& counts) {
  TexelSample sample;
  const Attitude attitude(texel, bundle.frame.direction);
  if (std::fabs(attitude.geometric) < kLeastCosine) return sample;
  const std::uint32_t near_side = 2 * index + (attitude.looks_back() ? 0U : 1U);
  const auto partners = partners_of(texel, near_side, attitude, bundle);
  if (!partners) {
    counts.unmatched += 1;
    return sample;
  }
  counts.receivers += 2;
  sample.weight = std::fabs(attitude.shading);
  add_sender(partners->before, partners->line_px, bundle, solution, sample.sides[near_side % 2],
             counts);
  add_sender(partners->after, partners->line_px, bundle, solution, sample.sides[1 - near_side % 2],
             counts);
  scale(attitude.lit_cosine(), sample);
  return sample;
}

constexpr std::size_t kBucketTexels = 4096;
constexpr std::size_t kLookAhead = 16;  ///< transfers
/// Set in a transfer's sender: the rest is its place among the detailed ones. Ends have it, too.
constexpr std::uint32_t kDetailed = 0x80000000U;

/// Hands every side on the lines of a band to `add`, with the sender that looks at it.
/// @param sender_of  what stands for a node's side on a line of the band
template <typename Add, typename SenderOf>
void visit_neighbours(const BundleLists::Band& band, const Add& add, const SenderOf& sender_of) {
  std::size_t begin = 0;
  for (std::size_t line = 0; line < band.ends.size(); ++line) {
    const std::size_t end = band.ends[line];
    std::uint32_t before = kBehind;
    for (std::size_t i = begin; i < end; ++i) {
      const ListNode& node = band.nodes[i];
      add(node.near_side, before);
      if (i + 1 == end) {
        add(far_side(node), kAhead);
        break;
      }
      const ListNode& next = band.nodes[i + 1];
      add(far_side(node), sender_of(next, next.near_side, line));
      before = sender_of(node, far_side(node), line);
    }
    begin = end;
  }
}

}  // namespace

SentLight light_of(const Sender& sender, const glm::ivec2& line_px, const Bundle& bundle,
                   const LightSolution& solution) {
  if (bundle.detail != nullptr) {
    const auto colors = colors_at(sender.side / 2,
                                  bundle.frame.point(line_px.x, line_px.y, sender.depth_m), bundle);
    if (colors) return detailed_light(sender.side, *colors, solution);
  }
  return mean_light(sender.side, solution);
}

std::optional<Partners> find_partners(const ExchangeTexel& point, std::uint32_t texel,
                                      const Bundle& bundle) {
  const Attitude attitude(point, bundle.frame.direction);
  if (std::fabs(attitude.geometric) < kLeastCosine) return std::nullopt;
  return partners_of(point, 2 * texel + (attitude.looks_back() ? 0U : 1U), attitude, bundle);
}

std::vector<ExchangeTexel> exchange_texels(const texel_atlas::TexelAtlas& atlas) {
  std::vector<ExchangeTexel> texels;
  texels.reserve(atlas.texels().size());
  for (const texel_atlas::Texel& texel : atlas.texels()) {
    texels.push_back({texel.point.position, texel.area_m2, texel.point.geometric_normal,
                      texel.point.shading_normal});
  }
  return texels;
}

ExchangeCounts gather(std::span<const ExchangeTexel> texels, const Bundle& bundle,
                      LightSolution& solution) {
  constexpr std::size_t kGrain = 2048;
  SharedCounts shared;
  base::parallel_for(texels.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    ExchangeCounts counts;
    for (std::size_t i = begin; i < end; ++i) {
      const auto index = static_cast<std::uint32_t>(i);
      solution.receive(index, gather_texel(texels[i], index, bundle, solution, counts));
    }
    shared.add(counts);
  });
  return shared.total();
}

Scatter::Scatter(std::span<const ExchangeTexel> texels)
    : texels_(texels), bucket_count_((texels.size() + kBucketTexels - 1) / kBucketTexels) {}

ExchangeCounts Scatter::exchange(const Bundle& bundle, LightSolution& solution) {
  const std::size_t bands = bundle.lists.band_count();
  while (bands_.size() < bands) {
    bands_.push_back({std::vector<std::vector<Transfer>>(bucket_count_), {}});
  }
  base::parallel_for(bands, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band) sort_band(bundle, band);
  });
  SharedCounts shared;
  base::parallel_for(bucket_count_, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t bucket = begin; bucket < end; ++bucket) {
      shared.add(add_bucket(bundle, bucket, solution));
    }
  });
  return shared.total();
}

void Scatter::sort_band(const Bundle& bundle, std::size_t index) {
  Band& band = bands_[index];
  for (std::vector<Transfer>& bucket : band.buckets) bucket.clear();
  band.detailed.clear();
  const auto add = [&](std::uint32_t receiver, std::uint32_t sender) {
    band.buckets[receiver / (2 * kBucketTexels)].push_back({receiver, sender});
  };
  if (bundle.detail == nullptr) {
    visit_neighbours(bundle.lists.band(index), add,
                     [](const ListNode&, std::uint32_t side, std::size_t) { return side; });
    return;
  }
  const auto width = static_cast<std::size_t>(bundle.lists.width_px());
  const auto first_row = static_cast<int>(index) * BundleLists::kBandRows;
  const auto sender_of = [&](const ListNode& node, std::uint32_t side, std::size_t line) {
    const glm::vec3 position = bundle.frame.point(
        static_cast<int>(line % width), first_row + static_cast<int>(line / width), node.depth_m);
    const auto colors = colors_at(texel_of(node), position, bundle);
    if (!colors) return side;
    band.detailed.push_back({side, *colors});
    return kDetailed | static_cast<std::uint32_t>(band.detailed.size() - 1);
  };
  visit_neighbours(bundle.lists.band(index), add, sender_of);
}

/// Of an end or a detailed sender.
void Scatter::add_special(const Transfer& transfer, const Band& band, const Bundle& bundle,
                          const LightSolution& solution, TexelSample& sample,
                          ExchangeCounts& counts) {
  TexelSample::SideLight& sum = sample.sides[transfer.receiver % 2];
  if (is_end(transfer.sender)) {
    add_end(transfer.sender, bundle.ends, sum);
  } else {
    const DetailedSender& sender = band.detailed[transfer.sender & ~kDetailed];
    add_light(detailed_light(sender.side, sender.colors, solution), sum, counts);
  }
}

ExchangeCounts Scatter::add_bucket(const Bundle& bundle, std::size_t bucket,
                                   LightSolution& solution) const {
  const std::size_t first = bucket * kBucketTexels;
  const std::size_t count = std::min(kBucketTexels, texels_.size() - first);
  thread_local std::vector<TexelSample> samples;
  samples.assign(count, {});
  ExchangeCounts counts;
  for (std::size_t band = 0; band < bundle.lists.band_count(); ++band) {
    const std::vector<Transfer>& transfers = bands_[band].buckets[bucket];
    for (std::size_t i = 0; i < transfers.size(); ++i) {
      const Transfer& transfer = transfers[i];
      // Senders lie anywhere in memory.
      const std::uint32_t later = transfers[std::min(i + kLookAhead, transfers.size() - 1)].sender;
      if (later < kDetailed) __builtin_prefetch(&solution.reflected(later));
      TexelSample& sample = samples[transfer.receiver / 2 - first];
      // Both sides of a texel are met by every line that meets it; one of them counts.
      sample.weight += static_cast<float>(transfer.receiver % 2);
      if (transfer.sender < kDetailed) {
        add_mean_light(transfer.sender, solution, sample.sides[transfer.receiver % 2], counts);
      } else {
        add_special(transfer, bands_[band], bundle, solution, sample, counts);
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    TexelSample& sample = samples[i];
    const ExchangeTexel& texel = texels_[first + i];
    const Attitude attitude(texel, bundle.frame.direction);
    if (attitude.geometric == 0.0F) {
      // Seen from the side to the last bit: crossings there are rounding, a density has none.
      sample = {};
    } else if (sample.weight > 0.0F) {
      // Lines meet the surface with density |n_g . w|; the shading normal's cosine takes its place.
      const float per_line =
          bundle.frame.pixel_area_m2() / (texel.area_m2 * std::fabs(attitude.geometric));
      sample.weight *= per_line * std::fabs(attitude.shading);
      scale(per_line * attitude.lit_cosine(), sample);
      counts.receivers += 2;
    }
    solution.receive(static_cast<std::uint32_t>(first + i), sample);
  }
  return counts;
}

}  // namespace renderers::ray_bundles

#include "renderers/ray_bundles/light_solution.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "perception/base/parallel.h"

namespace renderers::ray_bundles {

namespace {

constexpr std::size_t kGrain = 16384;

}  // namespace

LightSolution::LightSolution(const texel_atlas::TexelAtlas& atlas, const SolutionSettings& settings)
    : atlas_(atlas), settings_(settings) {
  const std::size_t sides = 2 * atlas.texels().size();
  emitted_.resize(sides);
  for (std::size_t i = 0; settings.carries_emission && i < atlas.texels().size(); ++i) {
    emitted_[2 * i] = atlas.texels()[i].emission;
  }
  known_.resize(sides);
  direct_.resize(sides);
  feed_.resize(sides);
  window_.resize(sides);
  older_.resize(sides);
  if (settings.feed == FeedKind::jacobi) total_.resize(sides);
  sent_.resize(sides);
  next_sent_.resize(sides);
}

void LightSolution::set_known_direct(std::vector<glm::vec3> incident) {
  assert(incident.size() == side_count() && directions_ == 0);
  known_ = std::move(incident);
  for (std::uint32_t side = 0; side < side_count(); ++side) {
    const bool is_black = side % 2 == 1 && !settings_.has_back_sides;
    if (is_black) known_[side] = glm::vec3(0.0F);
    sent_[side] = atlas_.texels()[side / 2].albedo * known_[side];
  }
}

void LightSolution::begin_direction() {
  const bool forgets = settings_.feed == FeedKind::stochastic;
  base::parallel_for(side_count(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t side = begin; side < end; ++side) {
      next_sent_[side] = sent_[side];
      if (!forgets) continue;
      // A side that the next bundle misses has nothing to send on.
      feed_[side] = glm::vec3(0.0F);
      next_sent_[side] =
          atlas_.texels()[side / 2].albedo * direct(static_cast<std::uint32_t>(side));
    }
  });
  const bool restarts = settings_.feed == FeedKind::growing_step && settings_.restarts_output &&
                        std::has_single_bit(static_cast<std::uint64_t>(directions_));
  if (restarts) begin_window();
}

/// The output is the mean over the last two windows: of N directions the last N / 2 to 3 N / 4,
/// without knowing N beforehand.
void LightSolution::begin_window() {
  std::swap(window_, older_);
  older_begin_ = window_begin_;
  window_begin_ = directions_;
  std::fill(window_.begin(), window_.end(), WeightedSum{});
}

void LightSolution::receive(std::uint32_t side, const SideSample& sample) {
  if (sample.weight <= 0.0F || (side % 2 == 1 && !settings_.has_back_sides)) return;
  WeightedSum& direct = direct_[side];
  direct.sum += sample.emitted;
  direct.weight += sample.weight;
  if (carries_reflected()) {
    window_[side].sum += sample.reflected;
    window_[side].weight += sample.weight;
    step_feed(side, sample);
  }
  if (settings_.feed == FeedKind::jacobi) return;
  // Direct light that bundles carry is known a little better after each of them.
  const glm::vec3 sources = mean(direct, static_cast<double>(directions_ + 1));
  const glm::vec3 incident = known_[side] + sources + feed_[side];
  next_sent_[side] = atlas_.texels()[side / 2].albedo * incident;
}

void LightSolution::step_feed(std::uint32_t side, const SideSample& sample) {
  glm::vec3& feed = feed_[side];
  switch (settings_.feed) {
    case FeedKind::growing_step: {
      const auto k = static_cast<float>(settings_.step_k);
      const auto i = static_cast<float>(directions_ - settings_.direct_only + 1);
      const float step = std::min(1.0F, 2.0F * sample.weight * k / (i + k));
      feed += step * (sample.reflected / sample.weight - feed);
      return;
    }
    case FeedKind::running_mean:
      // The paper counts all directions, those that carried no reflected light, too.
      if (settings_.normalisation == Normalisation::self) {
        feed = window_[side].sum / direct_[side].weight;
      } else {
        feed = window_[side].sum * (2.0F / static_cast<float>(directions_ + 1));
      }
      return;
    case FeedKind::stochastic:
      feed = 2.0F * sample.reflected;
      return;
    case FeedKind::jacobi:
      return;
  }
}

void LightSolution::end_direction() {
  ++directions_;
  std::swap(sent_, next_sent_);
  if (settings_.feed == FeedKind::jacobi && directions_ % settings_.bounce_directions == 0) {
    end_bounce();
  }
}

/// The light of a finished bounce is all that the next one reflects.
void LightSolution::end_bounce() {
  const auto count = static_cast<double>(settings_.bounce_directions);
  const bool is_first = directions_ == settings_.bounce_directions;
  // With direct light by bundles, the first bounce is the direct light's own.
  for (std::uint32_t side = 0; side < side_count(); ++side) {
    const glm::vec3 bounced = mean(window_[side], count);
    glm::vec3 incident = bounced;
    if (is_first) incident += mean(direct_[side], count);
    total_[side] += bounced;
    sent_[side] = atlas_.texels()[side / 2].albedo * incident;
    window_[side] = {};
  }
}

glm::vec3 LightSolution::mean(const WeightedSum& sum, double directions) const {
  if (settings_.normalisation == Normalisation::self) {
    return sum.weight > 0.0F ? sum.sum / sum.weight : glm::vec3(0.0F);
  }
  return directions > 0.0 ? sum.sum * static_cast<float>(2.0 / directions) : glm::vec3(0.0F);
}

glm::vec3 LightSolution::direct_of_bundles(std::uint32_t side) const {
  return mean(direct_[side], static_cast<double>(directions_));
}

glm::vec3 LightSolution::direct(std::uint32_t side) const {
  return known_[side] + direct_of_bundles(side);
}

glm::vec3 LightSolution::indirect(std::uint32_t side) const {
  const auto since = [&](std::int64_t begin) {
    return static_cast<double>(directions_ - std::max(begin, settings_.direct_only));
  };
  switch (settings_.feed) {
    case FeedKind::running_mean:
      return feed_[side];
    case FeedKind::jacobi:
      return total_[side];
    case FeedKind::stochastic:
      return mean(window_[side], since(0));
    case FeedKind::growing_step:
      break;
  }
  if (!settings_.restarts_output) return mean(window_[side], since(0));
  const WeightedSum both{window_[side].sum + older_[side].sum,
                         window_[side].weight + older_[side].weight};
  return mean(both, since(older_begin_));
}

std::int64_t LightSolution::memory_bytes() const {
  return static_cast<std::int64_t>(side_count() * 3 * sizeof(WeightedSum) +
                                   (5 * side_count() + total_.size()) * sizeof(glm::vec3));
}

}  // namespace renderers::ray_bundles

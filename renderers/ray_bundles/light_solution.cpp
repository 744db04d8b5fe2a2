#include "renderers/ray_bundles/light_solution.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "renderers/ray_bundles/glossy_transfer.h"

namespace renderers::ray_bundles {

void LightSolution::Sums::reset(std::size_t texels, std::int64_t first_direction) {
  light.assign(2 * texels, glm::vec3(0.0F));
  weight.assign(texels, 0.0F);
  begin = first_direction;
}

LightSolution::LightSolution(const texel_atlas::TexelAtlas& atlas, const SolutionSettings& settings)
    : settings_(settings) {
  const std::size_t texels = atlas.texels().size();
  for (const texel_atlas::Texel& texel : atlas.texels()) albedo_.push_back(texel.albedo);
  known_.resize(2 * texels);
  received_.feed.resize(2 * texels);
  sent_.resize(2 * texels);
  next_sent_.resize(2 * texels);
  if (settings.feed == FeedKind::jacobi) total_.resize(2 * texels);
  received_.direct.reset(texels, 0);
  received_.window.reset(texels, 0);
  received_.older.reset(texels, 0);
  if (!brings_emission()) return;
  emitted_.resize(2 * texels);
  for (std::size_t i = 0; i < texels; ++i) emitted_[2 * i] = atlas.texels()[i].emission;
}

void LightSolution::set_known_direct(std::vector<glm::vec3> incident) {
  assert(incident.size() == side_count() && directions_ == 0);
  known_ = std::move(incident);
  for (std::size_t side = 0; side < side_count(); ++side) {
    const bool is_black = side % 2 == 1 && !settings_.has_back_sides;
    if (is_black) known_[side] = glm::vec3(0.0F);
    sent_[side] = albedo_[side / 2] * known_[side];
  }
  if (glossy_ != nullptr) sent_by_all_ = sent_;
}

void LightSolution::set_glossy(GlossyTransfer* glossy) {
  assert(settings_.glossy_chain && directions_ == 0);
  glossy_ = glossy;
  sent_by_all_ = sent_;
}

void LightSolution::begin_direction(float weight) {
  direction_weight_ = weight;
  const bool restarts = settings_.feed == FeedKind::growing_step && settings_.restarts_output &&
                        std::has_single_bit(static_cast<std::uint64_t>(directions_));
  if (restarts) begin_window();
}

/// The output is the mean over the last two windows: of N directions the last N / 2 to 3 N / 4,
/// without knowing N beforehand.
void LightSolution::begin_window() {
  std::swap(received_.window, received_.older);
  received_.window.reset(texel_count(), directions_);
}

void LightSolution::receive(std::uint32_t texel, const TexelSample& sample) {
  if (direction_weight_ == 1.0F) {
    receive_weighted(texel, sample);
    return;
  }
  TexelSample weighted = sample;
  weighted.weight *= direction_weight_;
  for (TexelSample::SideLight& side : weighted.sides) {
    side.emitted *= direction_weight_;
    side.reflected *= direction_weight_;
  }
  receive_weighted(texel, weighted);
}

void LightSolution::receive_weighted(std::uint32_t texel, const TexelSample& sample) {
  if (glossy_ != nullptr) glossy_->receive(texel, sample);
  if (sample.weight <= 0.0F) {
    miss(texel);
    return;
  }
  received_.direct.weight[texel] += sample.weight;
  if (carries_reflected()) received_.window.weight[texel] += sample.weight;
  receive_side(2 * texel, sample.weight, sample.sides[0]);
  if (settings_.has_back_sides) receive_side(2 * texel + 1, sample.weight, sample.sides[1]);
}

/// A texel that the bundle misses goes on sending what it sent.
void LightSolution::miss(std::uint32_t texel) {
  for (std::uint32_t side = 2 * texel; side < 2 * texel + 2; ++side) {
    next_sent_[side] = sent_[side];
    if (settings_.feed != FeedKind::stochastic) continue;
    // The last direction's light is none.
    received_.feed[side] = glm::vec3(0.0F);
    next_sent_[side] = albedo_[texel] * direct(side);
  }
}

void LightSolution::receive_side(std::uint32_t side, float weight,
                                 const TexelSample::SideLight& light) {
  next_sent_[side] = sent_[side];
  constexpr glm::vec3 kBlack(0.0F);
  // In the dark, and so far always: nothing changes. Half of all sides look out of closed scenes.
  if (light.reflected == kBlack && light.emitted == kBlack && sent_[side] == kBlack &&
      received_.feed[side] == kBlack) {
    return;
  }
  if (settings_.carries_emission) received_.direct.light[side] += light.emitted;
  if (carries_reflected()) {
    received_.window.light[side] += light.reflected;
    step_feed(side, weight, light.reflected);
  }
  if (settings_.feed == FeedKind::jacobi) return;
  // Direct light that bundles carry is known a little better after each of them.
  glm::vec3 incident = known_[side] + received_.feed[side];
  if (settings_.carries_emission) {
    incident += mean(received_.direct.light[side], received_.direct.weight[side / 2],
                     static_cast<double>(directions_ + 1));
  }
  next_sent_[side] = albedo_[side / 2] * incident;
}

void LightSolution::step_feed(std::uint32_t side, float weight, const glm::vec3& reflected) {
  glm::vec3& feed = received_.feed[side];
  switch (settings_.feed) {
    case FeedKind::growing_step: {
      const auto k = static_cast<float>(settings_.step_k);
      const auto i = static_cast<float>(directions_ - settings_.direct_only + 1);
      const float step = std::min(1.0F, 2.0F * weight * k / (i + k));
      feed += step * (reflected / weight - feed);
      return;
    }
    case FeedKind::running_mean:
      // The paper counts all directions, those that carried no reflected light, too.
      feed = mean(received_.window.light[side], received_.direct.weight[side / 2],
                  static_cast<double>(directions_ + 1));
      return;
    case FeedKind::stochastic:
      feed = 2.0F * reflected;
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
  if (glossy_ == nullptr) return;
  glossy_->end_direction();
  sent_by_all_ = sent_;
  glossy_->add_to(sent_by_all_);
}

/// The light of a finished bounce is all that the next one reflects.
void LightSolution::end_bounce() {
  const auto count = static_cast<double>(settings_.bounce_directions);
  const bool is_first = directions_ == settings_.bounce_directions;
  for (std::uint32_t side = 0; side < side_count(); ++side) {
    const glm::vec3 bounced =
        mean(received_.window.light[side], received_.window.weight[side / 2], count);
    total_[side] += bounced;
    glm::vec3 incident = bounced;
    // Direct light by bundles took the first bounce's directions to arrive.
    if (is_first)
      incident += mean(received_.direct.light[side], received_.direct.weight[side / 2], count);
    sent_[side] = albedo_[side / 2] * incident;
  }
  received_.window.reset(texel_count(), directions_);
}

void LightSolution::set_received(Received received, std::vector<glm::vec3> sent) {
  assert(received.feed.size() == side_count() && sent.size() == side_count());
  assert(settings_.feed != FeedKind::jacobi && glossy_ == nullptr);
  received_ = std::move(received);
  sent_ = std::move(sent);
}

glm::vec3 LightSolution::mean(const glm::vec3& sum, float weight, double directions) const {
  if (settings_.normalisation == Normalisation::self) {
    return weight > 0.0F ? sum / weight : glm::vec3(0.0F);
  }
  return directions > 0.0 ? sum * static_cast<float>(2.0 / directions) : glm::vec3(0.0F);
}

glm::vec3 LightSolution::direct_of_bundles(std::uint32_t side) const {
  return mean(received_.direct.light[side], received_.direct.weight[side / 2],
              static_cast<double>(directions_));
}

glm::vec3 LightSolution::direct(std::uint32_t side) const {
  return known_[side] + direct_of_bundles(side);
}

glm::vec3 LightSolution::indirect(std::uint32_t side) const {
  const auto since = [&](const Sums& sums) {
    return static_cast<double>(directions_ - std::max(sums.begin, settings_.direct_only));
  };
  const std::size_t texel = side / 2;
  switch (settings_.feed) {
    case FeedKind::running_mean:
      return received_.feed[side];
    case FeedKind::jacobi:
      return total_[side];
    case FeedKind::stochastic:
      return mean(received_.window.light[side], received_.window.weight[texel],
                  since(received_.window));
    case FeedKind::growing_step:
      break;
  }
  if (!settings_.restarts_output) {
    return mean(received_.window.light[side], received_.window.weight[texel],
                since(received_.window));
  }
  return mean(received_.window.light[side] + received_.older.light[side],
              received_.window.weight[texel] + received_.older.weight[texel],
              since(received_.older));
}

std::int64_t LightSolution::memory_bytes() const {
  const std::size_t vectors =
      sent_by_all_.size() + emitted_.size() + total_.size() + 7 * side_count() + texel_count();
  return static_cast<std::int64_t>(vectors * sizeof(glm::vec3) + 3 * texel_count() * sizeof(float));
}

}  // namespace renderers::ray_bundles

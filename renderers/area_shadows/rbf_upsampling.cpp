#include "renderers/area_shadows/rbf_upsampling.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "perception/base/parallel.h"

namespace renderers::area_shadows {

namespace {

constexpr std::size_t kFragmentGrain = 16;

class RbfUpsampler {
 public:
  RbfUpsampler(const PixelSurfaces& surfaces, const FragmentSet& set, const FragmentLight& light,
               const RbfUpsamplingSettings& settings)
      : surfaces_(surfaces),
        set_(set),
        light_(light),
        settings_(settings),
        chooser_(settings.rbf) {}

  /// Writes the pixels of a final fragment.
  void fill(std::size_t index, PixelIrradiance& pixels) const;
  /// Writes how they get their values.
  void place(std::size_t index, std::vector<RbfPlace>& places) const;

 private:
  std::vector<std::size_t> touching(std::size_t index) const;
  std::vector<LightSample> candidates(std::size_t index) const;
  bool is_uniform(std::span<const LightSample> samples) const;
  /// What lies around tells about one of its surfaces only.
  bool holds_one_value(const Fragment& fragment) const {
    return fragment.level <= settings_.copied_level || fragment.crosses_surfaces;
  }
  bool is_copied_from(const Fragment& fragment, std::span<const LightSample> samples) const {
    return holds_one_value(fragment) || is_uniform(samples);
  }

  const PixelSurfaces& surfaces_;
  const FragmentSet& set_;
  const FragmentLight& light_;
  const RbfUpsamplingSettings& settings_;
  BaseChooser chooser_;
};

/// The fragments around one, in the order of their indices.
std::vector<std::size_t> RbfUpsampler::touching(std::size_t index) const {
  const PixelBox box = pixels_of(set_.fragments[index], set_);
  std::vector<std::size_t> found;
  found.reserve(static_cast<std::size_t>(4 * set_.fragments[index].side_px() + 4));
  const auto look = [&](int x, int y) {
    if (!set_.holds({x, y})) return;
    const std::int32_t other = set_.at[set_.pixel(x, y)];
    const bool is_noted = !found.empty() && found.back() == static_cast<std::size_t>(other);
    if (other != kNone && !is_noted) found.push_back(static_cast<std::size_t>(other));
  };
  for (int x = box.least.x - 1; x <= box.end.x; ++x) look(x, box.least.y - 1);
  for (int x = box.least.x - 1; x <= box.end.x; ++x) look(x, box.end.y);
  for (int y = box.least.y; y < box.end.y; ++y) look(box.least.x - 1, y);
  for (int y = box.least.y; y < box.end.y; ++y) look(box.end.x, y);
  std::ranges::sort(found);
  const auto rest = std::ranges::unique(found);
  found.erase(rest.begin(), rest.end());
  return found;
}

/// Its own sample alone if all others have its value, and nothing else can come out.
std::vector<LightSample> RbfUpsampler::candidates(std::size_t index) const {
  std::vector<LightSample> samples{light_.centres[index]};
  const auto own = light_.extras_of(index);
  samples.insert(samples.end(), own.begin(), own.end());
  const std::size_t own_count = samples.size();
  for (const std::size_t other : touching(index)) {
    samples.push_back(light_.centres[other]);
    const auto extras = light_.extras_of(other);
    samples.insert(samples.end(), extras.begin(), extras.end());
  }
  // Whose surfaces they lie on takes longer to find out.
  if (is_uniform(samples)) {
    samples.resize(1);
    return samples;
  }
  const auto& surface = surfaces_.pixels[static_cast<std::size_t>(samples.front().pixel)];
  const auto is_elsewhere = [&](const LightSample& sample) {
    const auto& other = surfaces_.pixels[static_cast<std::size_t>(sample.pixel)];
    return !is_same_surface(surface, other, settings_.same_surface);
  };
  samples.erase(std::remove_if(samples.begin() + static_cast<std::ptrdiff_t>(own_count),
                               samples.end(), is_elsewhere),
                samples.end());
  return samples;
}

/// Whether interpolation between the samples can only give their common value.
bool RbfUpsampler::is_uniform(std::span<const LightSample> samples) const {
  if (settings_.rbf.form == RbfForm::raw) return false;
  return std::ranges::all_of(samples, [&](const LightSample& sample) {
    return sample.irradiance == samples.front().irradiance;
  });
}

void RbfUpsampler::fill(std::size_t index, PixelIrradiance& pixels) const {
  const Fragment& fragment = set_.fragments[index];
  const PixelBox box = pixels_of(fragment, set_);
  std::vector<LightSample> samples{light_.centres[index]};
  if (!holds_one_value(fragment)) samples = candidates(index);
  const bool is_copied = is_copied_from(fragment, samples);
  for (int y = box.least.y; y < box.end.y; ++y) {
    for (int x = box.least.x; x < box.end.x; ++x) {
      glm::vec3& pixel = pixels[set_.pixel(x, y)];
      if (is_copied) {
        pixel = samples.front().irradiance;
        continue;
      }
      const glm::vec2 place(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      pixel = interpolate(place, chooser_.choose(place, samples),
                          static_cast<float>(fragment.side_px()), settings_.rbf);
    }
  }
}

/// Whether some direction from a place has all bases at more than a right angle: a half plane holds
/// them all, or the two of them that are next to each other around it are more than half a turn
/// apart.
bool lies_outside(const glm::vec2& place_px, const Bases& bases) {
  std::vector<float> angles;
  for (std::size_t i = 0; i < bases.count; ++i) {
    const glm::vec2 step = bases.samples[i]->position_px - place_px;
    if (step == glm::vec2(0.0F)) return false;
    angles.push_back(std::atan2(step.y, step.x));
  }
  if (angles.empty()) return true;
  std::ranges::sort(angles);
  constexpr float kTurn = 6.2831853F;
  float gap = angles.front() + kTurn - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  // A place on the line between two bases is enclosed by them.
  return gap > 0.5F * kTurn + 1e-4F;
}

void RbfUpsampler::place(std::size_t index, std::vector<RbfPlace>& places) const {
  const Fragment& fragment = set_.fragments[index];
  if (holds_one_value(fragment)) return;
  const std::vector<LightSample> samples = candidates(index);
  if (is_copied_from(fragment, samples)) return;
  const PixelBox box = pixels_of(fragment, set_);
  for (int y = box.least.y; y < box.end.y; ++y) {
    for (int x = box.least.x; x < box.end.x; ++x) {
      const glm::vec2 at_px(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      places[set_.pixel(x, y)] = lies_outside(at_px, chooser_.choose(at_px, samples))
                                     ? RbfPlace::extrapolated
                                     : RbfPlace::enclosed;
    }
  }
}

}  // namespace

std::vector<RbfPlace> rbf_places(const PixelSurfaces& surfaces, const FragmentSet& set,
                                 const FragmentLight& light,
                                 const RbfUpsamplingSettings& settings) {
  std::vector<RbfPlace> places(set.at.size(), RbfPlace::copied);
  const RbfUpsampler upsampler(surfaces, set, light, settings);
  base::parallel_for(set.fragments.size(), kFragmentGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (set.fragments[i].state == Fragment::State::final) upsampler.place(i, places);
    }
  });
  return places;
}

PixelIrradiance upsample_by_rbf(const PixelSurfaces& surfaces, const FragmentSet& set,
                                const FragmentLight& light, const RbfUpsamplingSettings& settings) {
  PixelIrradiance pixels(set.at.size(), glm::vec3(0.0F));
  const RbfUpsampler upsampler(surfaces, set, light, settings);
  base::parallel_for(set.fragments.size(), kFragmentGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (set.fragments[i].state == Fragment::State::final) upsampler.fill(i, pixels);
    }
  });
  return pixels;
}

}  // namespace renderers::area_shadows

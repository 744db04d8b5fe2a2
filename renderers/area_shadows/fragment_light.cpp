#include "renderers/area_shadows/fragment_light.h"

#include "perception/base/parallel.h"

namespace renderers::area_shadows {

namespace {

using ray_tracing::group_factors;
using ray_tracing::group_irradiance;

constexpr std::size_t kFragmentGrain = 64;

class Lighting {
 public:
  Lighting(ShadowTracer& tracer, const FragmentLightSettings& settings)
      : tracer_(tracer), settings_(settings), set_groups_(tracer.groups() / 4) {}

  /// Casts the rays that `light_of` needs and nobody cast before. @return how many
  std::uint64_t trace(const FragmentSet& set, bool is_coarse) const;
  /// Everything it needs must be known.
  PixelLight light_of(const Fragment& fragment) const {
    PixelLight sum;
    if (fragment.is_culled) return sum;
    if (is_pixel(fragment)) {
      return tracer_.light_of(static_cast<std::size_t>(fragment.pixels[0]));
    }
    for (std::size_t light = 0; light < tracer_.lights().size(); ++light) {
      const PixelLight of_light = by_bits(fragment, light);
      sum.irradiance += of_light.irradiance;
      sum.open += of_light.open;
    }
    return sum;
  }

 private:
  /// What the points of some groups give a pixel, as it is and as it would be without occluders.
  struct Pair {
    glm::vec3 visible{0.0F};
    glm::vec3 facing{0.0F};
  };
  /// Whether the fragment's first pixel speaks for it, by all points.
  bool is_pixel(const Fragment& fragment) const {
    return fragment.level == 0 || settings_.estimate == IrradianceEstimate::pixel;
  }
  std::size_t first_group(std::size_t quadrant) const {
    return settings_.has_rotated_points ? quadrant * set_groups_ : 0;
  }
  void ask_for_bits(const Fragment& fragment) const;
  Pair of_quadrant(std::int32_t pixel, std::size_t light, std::size_t first) const;
  glm::vec3 unoccluded(std::int32_t pixel, std::size_t light, std::size_t first) const;
  PixelLight by_bits(const Fragment& fragment, std::size_t light) const;

  ShadowTracer& tracer_;
  const FragmentLightSettings& settings_;
  std::size_t set_groups_;
};

std::uint64_t Lighting::trace(const FragmentSet& set, bool is_coarse) const {
  for (const Fragment& fragment : set.fragments) {
    if (fragment.state != Fragment::State::final || fragment.is_culled ||
        (fragment.level > 0) != is_coarse) {
      continue;
    }
    if (is_pixel(fragment)) {
      tracer_.ask_pixel(static_cast<std::uint32_t>(fragment.pixels[0]));
    } else {
      ask_for_bits(fragment);
    }
  }
  return tracer_.trace();
}

void Lighting::ask_for_bits(const Fragment& fragment) const {
  for (std::size_t quadrant = 0; quadrant < 4; ++quadrant) {
    if (fragment.pixels[quadrant] == kNone) continue;
    for (std::size_t light = 0; light < tracer_.lights().size(); ++light) {
      for (std::size_t group = 0; group < set_groups_; ++group) {
        tracer_.ask({static_cast<std::uint32_t>(fragment.pixels[quadrant]),
                     static_cast<std::uint32_t>(light),
                     static_cast<std::uint16_t>(first_group(quadrant) + group)});
      }
    }
  }
}

Lighting::Pair Lighting::of_quadrant(std::int32_t pixel, std::size_t light,
                                     std::size_t first) const {
  const auto index = static_cast<std::size_t>(pixel);
  const auto& receiver = tracer_.surfaces().pixels[index].receiver;
  const auto& points = tracer_.lights()[light];
  Pair pair;
  for (std::size_t group = first; group < first + set_groups_; ++group) {
    if (tracer_.facing(index, light, group) == 0) continue;
    const auto factors = group_factors(points, group, receiver);
    const std::uint32_t visible = tracer_.known(index, light, group);
    const glm::vec3 open = group_irradiance(points, group, factors, factors.facing);
    pair.facing += open;
    pair.visible +=
        visible == factors.facing ? open : group_irradiance(points, group, factors, visible);
  }
  return pair;
}

glm::vec3 Lighting::unoccluded(std::int32_t pixel, std::size_t light, std::size_t first) const {
  const auto& receiver = tracer_.surfaces().pixels[static_cast<std::size_t>(pixel)].receiver;
  const auto& points = tracer_.lights()[light];
  glm::vec3 sum(0.0F);
  for (std::size_t group = first; group < first + set_groups_; ++group) {
    const auto factors = group_factors(points, group, receiver);
    sum += group_irradiance(points, group, factors, factors.facing);
  }
  return sum;
}

/// Each quadrant speaks for the whole fragment with a quarter of the points: four of a pixel's
/// irradiance by all points, by the number of quadrants.
PixelLight Lighting::by_bits(const Fragment& fragment, std::size_t light) const {
  Pair sum;
  glm::vec3 open(0.0F);
  float count = 0.0F;
  for (std::size_t quadrant = 0; quadrant < 4; ++quadrant) {
    const std::int32_t pixel = fragment.pixels[quadrant];
    if (pixel == kNone) continue;
    count += 1.0F;
    const std::size_t own = quadrant * set_groups_;
    const std::size_t first = first_group(quadrant);
    const Pair pair = of_quadrant(pixel, light, first);
    sum.visible += pair.visible;
    sum.facing += pair.facing;
    const bool has_other_points = settings_.estimate == IrradianceEstimate::ratio && own != first;
    open += has_other_points ? unoccluded(pixel, light, own) : pair.facing;
  }
  const float weight = 4.0F / count;
  PixelLight result{weight * sum.visible, weight * open};
  if (settings_.estimate == IrradianceEstimate::sum) return result;
  for (int c = 0; c < 3; ++c) {
    result.irradiance[c] =
        sum.facing[c] > 0.0F ? result.open[c] * (sum.visible[c] / sum.facing[c]) : 0.0F;
  }
  return result;
}

/// Where each fragment's extra samples stand in the list of all.
void place_extras(const FragmentSet& set, const FragmentLightSettings& settings,
                  FragmentLight& light) {
  for (std::size_t i = 0; i < set.fragments.size(); ++i) {
    light.first_extra.push_back(static_cast<std::uint32_t>(light.extras.size()));
    const Fragment& fragment = set.fragments[i];
    if (!settings.has_extra_samples || fragment.state != Fragment::State::final ||
        fragment.is_culled || fragment.level < settings.extra_from_level) {
      continue;
    }
    for (const std::int32_t pixel : extra_pixels(fragment, set)) {
      LightSample sample;
      sample.pixel = pixel;
      sample.position_px = {static_cast<float>(pixel % set.width_px) + 0.5F,
                            static_cast<float>(pixel / set.width_px) + 0.5F};
      light.extras.push_back(sample);
    }
  }
  light.first_extra.push_back(static_cast<std::uint32_t>(light.extras.size()));
}

}  // namespace

bool is_dark(const Fragment& fragment, const FragmentSet& set, const ShadowTracer& tracer) {
  const PixelBox box = pixels_of(fragment, set);
  for (int y = box.least.y; y < box.end.y; ++y) {
    for (int x = box.least.x; x < box.end.x; ++x) {
      if (tracer.may_be_lit(set.pixel(x, y))) return false;
    }
  }
  return true;
}

std::vector<std::int32_t> extra_pixels(const Fragment& fragment, const FragmentSet& set) {
  const glm::ivec2 corner = fragment.corner();
  const int half = fragment.side_px() / 2;
  std::vector<std::int32_t> pixels;
  for (const glm::ivec2& step : {glm::ivec2(0, 0), glm::ivec2(half, 0), glm::ivec2(0, half)}) {
    const glm::ivec2 at = corner + step;
    if (set.holds(at)) pixels.push_back(static_cast<std::int32_t>(set.pixel(at.x, at.y)));
  }
  return pixels;
}

FragmentLight light_fragments(ShadowTracer& tracer, const FragmentSet& set,
                              const FragmentLightSettings& settings) {
  FragmentLight light;
  light.centres.resize(set.fragments.size());
  place_extras(set, settings, light);
  const Lighting lighting(tracer, settings);
  light.coarse_gather_rays = lighting.trace(set, true);
  light.gather_rays = light.coarse_gather_rays + lighting.trace(set, false);
  base::parallel_for(set.fragments.size(), kFragmentGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Fragment& fragment = set.fragments[i];
      if (fragment.state != Fragment::State::final) continue;
      const PixelLight value = lighting.light_of(fragment);
      light.centres[i] = {centre_of(fragment, set), value.irradiance, value.open,
                          first_pixel(fragment)};
    }
  });
  std::vector<std::uint32_t> extras;
  for (const LightSample& sample : light.extras) {
    extras.push_back(static_cast<std::uint32_t>(sample.pixel));
  }
  light.extra_rays = tracer.trace_pixels(extras);
  base::parallel_for(light.extras.size(), kFragmentGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      LightSample& sample = light.extras[i];
      const PixelLight value = tracer.light_of(static_cast<std::size_t>(sample.pixel));
      sample.irradiance = value.irradiance;
      sample.open = value.open;
    }
  });
  return light;
}

}  // namespace renderers::area_shadows

#include "renderers/area_shadows/fragment_pictures.h"

#include <algorithm>
#include <map>

#include "renderers/area_shadows/fragment_upsampling.h"
#include "renderers/area_shadows/shadow_picture.h"

namespace renderers::area_shadows {

namespace {

using perception::Image;

Image plane_of(const FragmentSet& set, float value) {
  Image image = perception::make_gray_image(set.width_px, set.height_px, "Y",
                                            perception::Encoding::scene_linear);
  std::ranges::fill(image.pixels, value);
  return image;
}

/// One value per pixel of what its fragment says.
template <typename ValueOf>
Image fragment_plane(const FragmentSet& set, const ValueOf& value_of) {
  Image image = plane_of(set, -1.0F);
  for (std::size_t pixel = 0; pixel < set.at.size(); ++pixel) {
    if (set.at[pixel] == kNone) continue;
    image.pixels[pixel] = value_of(set.fragments[static_cast<std::size_t>(set.at[pixel])], pixel);
  }
  return image;
}

Image pieces_plane(const FragmentSet& set) {
  Image image = fragment_plane(set, [](const Fragment&, std::size_t) { return 0.0F; });
  // Parts come after what they were cut from, but for those of reopened fragments.
  std::vector<const Fragment*> cut;
  for (const Fragment& fragment : set.fragments) {
    if (fragment.pieces > 0) cut.push_back(&fragment);
  }
  std::ranges::stable_sort(cut, std::ranges::greater{}, [](const Fragment* f) { return f->level; });
  for (const Fragment* fragment : cut) {
    const PixelBox box = pixels_of(*fragment, set);
    for (int y = box.least.y; y < box.end.y; ++y) {
      for (int x = box.least.x; x < box.end.x; ++x) {
        float& pixel = image.pixels[set.pixel(x, y)];
        if (pixel >= 0.0F) pixel = static_cast<float>(fragment->pieces);
      }
    }
  }
  return image;
}

Image extras_plane(const FragmentSet& set, const FragmentLight& light) {
  Image image = fragment_plane(set, [](const Fragment&, std::size_t) { return 0.0F; });
  for (const LightSample& sample : light.extras) {
    image.pixels[static_cast<std::size_t>(sample.pixel)] = 1.0F;
  }
  return image;
}

bool is_dark(const Fragment& fragment, const ShadowTracer& tracer) {
  return std::ranges::all_of(fragment.pixels, [&](std::int32_t pixel) {
    return pixel == kNone || tracer.lit_points(static_cast<std::size_t>(pixel)) == 0;
  });
}

constexpr int kCoarseLevel = 3;
constexpr int kEnoughSamples = 3;

/// Extra samples of a picture along the edges of coarse fragments.
class EdgeSamples {
 public:
  EdgeSamples(const FragmentSet& set, const FragmentLight& light)
      : set_(set), is_extra_(set.at.size()) {
    for (const LightSample& sample : light.extras) {
      is_extra_[static_cast<std::size_t>(sample.pixel)] = true;
    }
  }
  /// Those at its corners and in the middle of its edges; the right and lower ones belong to the
  /// neighbours.
  int along(const Fragment& fragment) const {
    const int half_px = fragment.side_px() / 2;
    int count = 0;
    for (int step = 0; step < 9; ++step) {
      const glm::ivec2 at = fragment.corner() + half_px * glm::ivec2(step % 3, step / 3);
      if (step != 4 && set_.holds(at) && is_extra_[set_.pixel(at.x, at.y)]) ++count;
    }
    return count;
  }

 private:
  const FragmentSet& set_;
  std::vector<bool> is_extra_;
};

}  // namespace

std::vector<perception::NamedImage> fragment_pictures(const FragmentSet& set,
                                                      const FragmentLight& light,
                                                      const ShadowTracer& tracer) {
  std::vector<perception::NamedImage> images;
  images.push_back({"level", fragment_plane(set, [](const Fragment& fragment, std::size_t) {
                      return static_cast<float>(fragment.level);
                    })});
  images.push_back({"lit_points", fragment_plane(set, [&](const Fragment&, std::size_t pixel) {
                      return static_cast<float>(tracer.lit_points(pixel));
                    })});
  images.push_back({"pieces", pieces_plane(set)});
  images.push_back({"extra_samples", extras_plane(set, light)});
  images.push_back({"culled", fragment_plane(set, [](const Fragment& fragment, std::size_t) {
                      return fragment.is_culled ? 1.0F : 0.0F;
                    })});
  images.push_back(
      {"fragment_irradiance", image_of(tracer.surfaces(), upsample_nearest(set, light))});
  return images;
}

std::vector<std::pair<std::string, CounterValue>> fragment_counters(const FragmentSet& set,
                                                                    const FragmentLight& light,
                                                                    const ShadowTracer& tracer) {
  double finals = 0.0;
  double culled = 0.0;
  double dark = 0.0;
  double coarse = 0.0;
  double edged = 0.0;
  const EdgeSamples edge_samples(set, light);
  std::vector<double> levels;
  std::map<int, double> pieces{{4, 0.0}, {10, 0.0}, {13, 0.0}, {16, 0.0}};
  for (const Fragment& fragment : set.fragments) {
    if (fragment.pieces > 0 && pieces.contains(fragment.pieces)) pieces[fragment.pieces] += 1.0;
    if (fragment.state != Fragment::State::final) continue;
    finals += 1.0;
    const auto level = static_cast<std::size_t>(fragment.level);
    if (levels.size() <= level) levels.resize(level + 1);
    levels[level] += 1.0;
    if (!fragment.is_culled && fragment.level >= kCoarseLevel) {
      coarse += 1.0;
      if (edge_samples.along(fragment) >= kEnoughSamples) edged += 1.0;
    }
    if (fragment.is_culled) {
      culled += 1.0;
    } else if (level > 0 && is_dark(fragment, tracer)) {
      dark += 1.0;
    }
  }
  const auto number = [](auto value) { return static_cast<double>(value); };
  std::vector<std::pair<std::string, CounterValue>> counters{
      {"fragments", finals + number(light.extras.size())},
      {"final_fragments", finals},
      {"extra_samples", number(light.extras.size())},
      {"culled_fragments", culled},
      {"dark_fragments", dark},
      {"tested_fragments", number(set.tested)},
      {"rounds", number(set.rounds)},
      {"reopened_fragments", number(set.reopened)},
      {"visibility_rays", number(set.rays)},
      {"test_rays", number(set.test_rays)},
      {"gather_rays", number(light.gather_rays)},
      {"coarse_gather_rays", number(light.coarse_gather_rays)},
      {"extra_rays", number(light.extra_rays)},
      {"coarse_fragments", coarse},
      {"edged_fragments", edged},
      {"bit_bytes", number(tracer.memory_bytes())},
      {"level_fragments", levels}};
  for (const auto& [count, splits] : pieces) {
    counters.emplace_back("pieces_" + std::to_string(count), splits);
  }
  return counters;
}

}  // namespace renderers::area_shadows

#include "renderers/area_shadows/neighbour_refinement.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <glm/common.hpp>

#include "perception/base/parallel.h"
#include "renderers/area_shadows/fragment_light.h"

namespace renderers::area_shadows {

namespace {

constexpr std::size_t kFragmentGrain = 32;

class NeighbourRefinement {
 public:
  NeighbourRefinement(ShadowTracer& tracer, const DiscontinuityPyramid& discontinuities,
                      const NeighbourSettings& settings)
      : tracer_(tracer),
        surfaces_(tracer.surfaces()),
        discontinuities_(discontinuities),
        settings_(settings) {
    set_.width_px = surfaces_.width_px;
    set_.height_px = surfaces_.height_px;
    set_.at.assign(surfaces_.pixels.size(), kNone);
  }

  FragmentSet run();

 private:
  std::vector<Fragment> first_list() const;
  std::vector<Fragment> work_off(std::vector<Fragment> list);
  void prepare(Fragment& fragment) const;
  std::vector<std::int32_t> asked_pixels(const Fragment& fragment) const;
  void trace(std::vector<std::uint32_t> pixels);
  bool differs(const Fragment& fragment) const;
  int differing_bits(std::int32_t a, std::int32_t b) const;
  std::int32_t middle(int level, int x, int y) const;

  ShadowTracer& tracer_;
  const PixelSurfaces& surfaces_;
  const DiscontinuityPyramid& discontinuities_;
  const NeighbourSettings& settings_;
  FragmentSet set_;
};

/// The pixel after a block's centre, moved into the image.
std::int32_t NeighbourRefinement::middle(int level, int x, int y) const {
  const glm::ivec2 centre = glm::ivec2(x << level, y << level) + (1 << level) / 2;
  const glm::ivec2 at = glm::min(centre, glm::ivec2(set_.width_px - 1, set_.height_px - 1));
  return static_cast<std::int32_t>(set_.pixel(at.x, at.y));
}

std::vector<Fragment> NeighbourRefinement::first_list() const {
  std::vector<Fragment> list;
  const int level = settings_.coarsest_level;
  for (int y = 0; y < discontinuities_.rows(level); ++y) {
    for (int x = 0; x < discontinuities_.columns(level); ++x) {
      Fragment fragment;
      fragment.x = x;
      fragment.y = y;
      fragment.level = static_cast<std::int8_t>(level);
      list.push_back(fragment);
    }
  }
  return list;
}

FragmentSet NeighbourRefinement::run() {
  std::vector<Fragment> list = first_list();
  while (!list.empty()) list = work_off(std::move(list));
  return std::move(set_);
}

/// Marks what needs no rays: split by geometry, final in the dark; the rest stays open.
void NeighbourRefinement::prepare(Fragment& fragment) const {
  fragment.pixels[0] = middle(fragment.level, fragment.x, fragment.y);
  if (fragment.level > 0 &&
      discontinuities_.is_discontinuous(fragment.level, fragment.x, fragment.y)) {
    fragment.state = Fragment::State::split;
  } else if (is_dark(fragment, set_, tracer_)) {
    fragment.state = Fragment::State::final;
    fragment.is_culled = true;
  } else if (fragment.level == 0) {
    fragment.state = Fragment::State::final;
  }
}

/// Its own middle, then those around it that lie on its surface.
std::vector<std::int32_t> NeighbourRefinement::asked_pixels(const Fragment& fragment) const {
  std::vector<std::int32_t> pixels{fragment.pixels[0]};
  const auto& own = surfaces_.pixels[static_cast<std::size_t>(fragment.pixels[0])];
  for (int y = fragment.y - 1; y <= fragment.y + 1; ++y) {
    for (int x = fragment.x - 1; x <= fragment.x + 1; ++x) {
      const bool is_inside = x >= 0 && y >= 0 && x < discontinuities_.columns(fragment.level) &&
                             y < discontinuities_.rows(fragment.level);
      if (!is_inside || (x == fragment.x && y == fragment.y)) continue;
      const std::int32_t pixel = middle(fragment.level, x, y);
      if (is_same_surface(own, surfaces_.pixels[static_cast<std::size_t>(pixel)],
                          settings_.same_surface)) {
        pixels.push_back(pixel);
      }
    }
  }
  return pixels;
}

void NeighbourRefinement::trace(std::vector<std::uint32_t> pixels) {
  std::ranges::sort(pixels);
  const auto rest = std::ranges::unique(pixels);
  pixels.erase(rest.begin(), rest.end());
  const std::uint64_t rays = tracer_.trace_pixels(pixels);
  set_.rays += rays;
  set_.test_rays += rays;
}

/// The greatest over the lights.
int NeighbourRefinement::differing_bits(std::int32_t a, std::int32_t b) const {
  int greatest = 0;
  for (std::size_t light = 0; light < tracer_.lights().size(); ++light) {
    int count = 0;
    for (std::size_t group = 0; group < tracer_.groups(); ++group) {
      count += std::popcount(tracer_.known(static_cast<std::size_t>(a), light, group) ^
                             tracer_.known(static_cast<std::size_t>(b), light, group));
    }
    greatest = std::max(greatest, count);
  }
  return greatest;
}

bool NeighbourRefinement::differs(const Fragment& fragment) const {
  return std::ranges::any_of(asked_pixels(fragment), [&](std::int32_t pixel) {
    return differing_bits(fragment.pixels[0], pixel) >= settings_.bit_threshold;
  });
}

/// @return the list of the next finer level
std::vector<Fragment> NeighbourRefinement::work_off(std::vector<Fragment> list) {
  std::erase_if(list, [&](const Fragment& fragment) {
    return !discontinuities_.has_surface(fragment.level, fragment.x, fragment.y);
  });
  if (list.empty()) return {};
  ++set_.rounds;
  const auto for_each = [&](const auto& body) {
    base::parallel_for(list.size(), kFragmentGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(list[i]);
    });
  };
  for_each([&](Fragment& fragment) { prepare(fragment); });
  std::vector<std::uint32_t> pixels;
  for (const Fragment& fragment : list) {
    if (fragment.state != Fragment::State::open) continue;
    const std::vector<std::int32_t> asked = asked_pixels(fragment);
    pixels.insert(pixels.end(), asked.begin(), asked.end());
    ++set_.tested;
  }
  trace(std::move(pixels));
  for_each([&](Fragment& fragment) {
    if (fragment.state != Fragment::State::open) return;
    fragment.state = differs(fragment) ? Fragment::State::split : Fragment::State::final;
  });
  std::vector<Fragment> finer;
  for (const Fragment& fragment : list) {
    if (fragment.state == Fragment::State::final) {
      label(fragment, static_cast<std::int32_t>(set_.fragments.size()), set_);
    } else {
      const Parts parts = parts_of(fragment, set_);
      finer.insert(finer.end(), parts.fragments.begin(),
                   parts.fragments.begin() + static_cast<std::ptrdiff_t>(parts.count));
    }
    set_.fragments.push_back(fragment);
  }
  return finer;
}

}  // namespace

FragmentSet refine_by_neighbours(ShadowTracer& tracer, const DiscontinuityPyramid& discontinuities,
                                 const NeighbourSettings& settings) {
  return NeighbourRefinement(tracer, discontinuities, settings).run();
}

}  // namespace renderers::area_shadows

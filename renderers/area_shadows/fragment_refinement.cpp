#include "renderers/area_shadows/fragment_refinement.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <utility>

#include "perception/base/parallel.h"
#include "renderers/area_shadows/fragment_light.h"

namespace renderers::area_shadows {

namespace {

constexpr std::size_t kFragmentGrain = 32;

/// What becomes of a fragment of the list.
enum class Verdict { final, culled, geometry, visibility };

struct Decision {
  Verdict verdict = Verdict::final;
  unsigned quadrants_cut_again = 0;        ///< bit per quadrant, GASS
  std::vector<std::int32_t> also_reopens;  ///< final fragments, no finer, that differ
};

class Refinement {
 public:
  Refinement(ShadowTracer& tracer, const DiscontinuityPyramid& discontinuities,
             const RefinementSettings& settings)
      : tracer_(tracer),
        surfaces_(tracer.surfaces()),
        discontinuities_(discontinuities),
        settings_(settings),
        set_groups_(tracer.groups() / 4),
        pending_(static_cast<std::size_t>(settings.coarsest_level) + 1) {
    set_.width_px = surfaces_.width_px;
    set_.height_px = surfaces_.height_px;
    set_.at.assign(surfaces_.pixels.size(), kNone);
  }

  FragmentSet run();

 private:
  void add(Fragment fragment);
  void start();
  void work_off(int level);
  Verdict verdict_without_rays(const Fragment& fragment) const;
  void ask_for_tests(const Fragment& fragment);
  void ask_for_extras(const Fragment& fragment);
  bool is_split_by_geometry(const Fragment& fragment) const;
  void compare_quadrants(const Fragment& fragment, Decision& decision) const;
  bool is_kept_across_surfaces(const Fragment& fragment) const;
  bool is_seen_alike(const Fragment& fragment) const;
  void compare_ring(std::int32_t index, Decision& decision) const;
  void compare_extras(const Fragment& fragment, Decision& decision) const;
  void compare_with(std::int32_t index, int quadrant, const glm::ivec2& at,
                    Decision& decision) const;
  /// A quadrant's pixel and the groups of points that it tests.
  struct Place {
    std::size_t pixel = 0;
    std::size_t first_group = 0;
  };
  struct Difference {
    int bits = 0;
    int gradient = 0;  ///< of the numbers of lit points
  };
  Place place_of(const Fragment& fragment, int quadrant) const;
  void ask(const Place& place);
  Difference difference_of(const Place& a, const Place& b) const;
  struct ComparedBits {
    std::uint32_t a;
    std::uint32_t b;
  };
  ComparedBits compared_bits(const Place& a, const Place& b, std::size_t light,
                             std::size_t group) const;
  void split(std::int32_t index, unsigned quadrants_cut_again);
  int points_per_test() const;
  int bit_threshold(int level) const;

  ShadowTracer& tracer_;
  const PixelSurfaces& surfaces_;
  const DiscontinuityPyramid& discontinuities_;
  const RefinementSettings& settings_;
  std::size_t set_groups_;  ///< groups of points that one quadrant tests
  FragmentSet set_;
  std::vector<std::vector<std::int32_t>> pending_;  ///< by level
};

void Refinement::add(Fragment fragment) {
  if (!discontinuities_.has_surface(fragment.level, fragment.x, fragment.y)) return;
  fragment.pixels = quadrant_pixels(fragment, set_);
  for (std::int32_t& pixel : fragment.pixels) {
    if (pixel != kNone && !discontinuities_.has_surface(static_cast<std::size_t>(pixel))) {
      pixel = kNone;
    }
  }
  pending_[static_cast<std::size_t>(fragment.level)].push_back(
      static_cast<std::int32_t>(set_.fragments.size()));
  set_.fragments.push_back(fragment);
}

void Refinement::start() {
  const int level = settings_.coarsest_level;
  for (int y = 0; y < discontinuities_.rows(level); ++y) {
    for (int x = 0; x < discontinuities_.columns(level); ++x) {
      Fragment fragment;
      fragment.x = x;
      fragment.y = y;
      fragment.level = static_cast<std::int8_t>(level);
      add(fragment);
    }
  }
}

FragmentSet Refinement::run() {
  start();
  for (int level = settings_.coarsest_level; level >= 0;) {
    if (pending_[static_cast<std::size_t>(level)].empty()) {
      --level;
      continue;
    }
    work_off(level);
    // What was reopened lies at coarser levels.
    while (level < settings_.coarsest_level &&
           std::ranges::any_of(pending_.begin() + level + 1, pending_.end(),
                               [](const auto& list) { return !list.empty(); })) {
      ++level;
    }
  }
  return std::move(set_);
}

void Refinement::work_off(int level) {
  const std::vector<std::int32_t> list =
      std::exchange(pending_[static_cast<std::size_t>(level)], {});
  std::vector<Decision> decisions(list.size());
  const auto for_each = [&](const auto& body) {
    base::parallel_for(list.size(), kFragmentGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(list[i], decisions[i]);
    });
  };
  const auto fragment_of = [&](std::int32_t index) -> Fragment& {
    return set_.fragments[static_cast<std::size_t>(index)];
  };
  ++set_.rounds;
  // Rays of one kind for all fragments at once.
  const auto trace_final = [&](const auto& ask) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (decisions[i].verdict == Verdict::final) ask(fragment_of(list[i]));
    }
    return tracer_.trace();
  };
  for_each([&](std::int32_t index, Decision& decision) {
    decision.verdict = verdict_without_rays(fragment_of(index));
    if (decision.verdict == Verdict::geometry) return;
    Fragment& fragment = fragment_of(index);
    fragment.crosses_surfaces = is_kept_across_surfaces(fragment);
    label(fragment, index, set_);  // fragments of a list share no pixels
  });
  std::uint64_t rays = trace_final([&](const Fragment& fragment) { ask_for_tests(fragment); });
  for_each([&](std::int32_t index, Decision& decision) {
    if (decision.verdict == Verdict::final) compare_quadrants(fragment_of(index), decision);
  });
  rays += trace_final([&](const Fragment& fragment) { ask_for_extras(fragment); });
  for_each([&](std::int32_t index, Decision& decision) {
    if (decision.verdict == Verdict::final) compare_extras(fragment_of(index), decision);
  });
  if (settings_.has_ring) {
    for_each([&](std::int32_t index, Decision& decision) {
      if (decision.verdict == Verdict::final || decision.verdict == Verdict::visibility) {
        compare_ring(index, decision);
      }
    });
  }
  set_.rays += rays;
  if (level > 0) set_.test_rays += rays;
  for (std::size_t i = 0; i < list.size(); ++i) {
    Fragment& fragment = fragment_of(list[i]);
    const Decision& decision = decisions[i];
    if (decision.verdict == Verdict::final || decision.verdict == Verdict::culled) {
      fragment.state = Fragment::State::final;
      fragment.is_culled = decision.verdict == Verdict::culled;
    }
    if (level > 0 && decision.verdict != Verdict::geometry && !fragment.is_culled) ++set_.tested;
    if (decision.verdict == Verdict::geometry) split(list[i], 0);
    if (decision.verdict == Verdict::visibility) split(list[i], decision.quadrants_cut_again);
    for (const std::int32_t coarser : decision.also_reopens) {
      if (fragment_of(coarser).state != Fragment::State::final) continue;
      ++set_.reopened;
      split(coarser, 0);
    }
  }
}

bool Refinement::is_split_by_geometry(const Fragment& fragment) const {
  if (first_pixel(fragment) == kNone) return true;
  return fragment.level > settings_.free_level &&
         discontinuities_.is_discontinuous(fragment.level, fragment.x, fragment.y);
}

/// Geometry, then culling. Fragments that need rays and a comparison come back as `final`.
Verdict Refinement::verdict_without_rays(const Fragment& fragment) const {
  if (is_split_by_geometry(fragment)) return Verdict::geometry;
  return is_dark(fragment, set_, tracer_) ? Verdict::culled : Verdict::final;
}

void Refinement::ask_for_tests(const Fragment& fragment) {
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    const std::int32_t pixel = fragment.pixels[static_cast<std::size_t>(quadrant)];
    if (pixel == kNone) continue;
    ask(place_of(fragment, quadrant));
  }
}

void Refinement::ask_for_extras(const Fragment& fragment) {
  if (settings_.extra_from_level < 0 || fragment.level < settings_.extra_from_level) return;
  for (const std::int32_t pixel : extra_pixels(fragment, set_)) {
    ask({static_cast<std::size_t>(pixel), 0});
  }
}

void Refinement::ask(const Place& place) {
  for (std::size_t light = 0; light < tracer_.lights().size(); ++light) {
    for (std::size_t group = 0; group < set_groups_; ++group) {
      tracer_.ask({static_cast<std::uint32_t>(place.pixel), static_cast<std::uint32_t>(light),
                   static_cast<std::uint16_t>(place.first_group + group)});
    }
  }
}

/// Bits of one group of two quadrants, as far as they can be compared.
Refinement::ComparedBits Refinement::compared_bits(const Place& a, const Place& b,
                                                   std::size_t light, std::size_t group) const {
  const std::size_t group_a = a.first_group + group;
  const std::size_t group_b = b.first_group + group;
  std::uint32_t both = ~0U;
  if (settings_.compares_facing) {
    both = tracer_.facing(a.pixel, light, group_a) & tracer_.facing(b.pixel, light, group_b);
  }
  return {tracer_.known(a.pixel, light, group_a) & both,
          tracer_.known(b.pixel, light, group_b) & both};
}

Refinement::Place Refinement::place_of(const Fragment& fragment, int quadrant) const {
  const bool is_first = settings_.test_points == TestPoints::same || fragment.level == 0;
  return {static_cast<std::size_t>(fragment.pixels[static_cast<std::size_t>(quadrant)]),
          is_first ? 0 : static_cast<std::size_t>(quadrant) * set_groups_};
}

/// The greatest over the lights; of rotated points the difference of their numbers.
[[gnu::target_clones("popcnt", "default")]] Refinement::Difference Refinement::difference_of(
    const Place& a, const Place& b) const {
  Difference greatest{0, 0};  // clang 16 leaves out constructors that only clones call
  for (std::size_t light = 0; light < tracer_.lights().size(); ++light) {
    int differing = 0;
    int gradient = 0;
    for (std::size_t group = 0; group < set_groups_; ++group) {
      const auto [bits_a, bits_b] = compared_bits(a, b, light, group);
      if (bits_a == bits_b) continue;
      differing += std::popcount(bits_a ^ bits_b);
      gradient += std::popcount(bits_a) - std::popcount(bits_b);
    }
    gradient = std::abs(gradient);
    const bool is_same = settings_.test_points == TestPoints::same;
    greatest.bits = std::max(greatest.bits, is_same ? differing : gradient);
    greatest.gradient = std::max(greatest.gradient, gradient);
  }
  return greatest;
}

int Refinement::points_per_test() const {
  if (tracer_.lights().empty()) return 0;
  return static_cast<int>(tracer_.lights()[0].points.size() / 4);
}

/// Of the coarser one of two fragments. A fragment above level 1 stands for pixels that nobody
/// tested, the more of them the coarser it is.
int Refinement::bit_threshold(int level) const {
  constexpr int kLeastOfCoarse = 2;  // rotated points differ by 1 without a cause
  const int fewer = settings_.bits_per_level * std::max(0, level - 1);
  return std::min(settings_.bit_threshold,
                  std::max(kLeastOfCoarse, settings_.bit_threshold - fewer));
}

/// Whether only `free_level` keeps it from being split for its geometry.
bool Refinement::is_kept_across_surfaces(const Fragment& fragment) const {
  return fragment.level > 0 && fragment.level <= settings_.free_level &&
         discontinuities_.is_discontinuous(fragment.level, fragment.x, fragment.y);
}

/// Whether its quadrants see all points that they face, or none of them does.
bool Refinement::is_seen_alike(const Fragment& fragment) const {
  bool sees_some = false;
  bool misses_some = false;
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    if (fragment.pixels[static_cast<std::size_t>(quadrant)] == kNone) continue;
    const Place place = place_of(fragment, quadrant);
    for (std::size_t light = 0; light < tracer_.lights().size(); ++light) {
      for (std::size_t group = place.first_group; group < place.first_group + set_groups_;
           ++group) {
        const std::uint32_t seen = tracer_.known(place.pixel, light, group);
        sees_some = sees_some || seen != 0;
        misses_some = misses_some || seen != tracer_.facing(place.pixel, light, group);
      }
    }
  }
  return !(sees_some && misses_some);
}

/// SFVT, and the gradients of GASS.
void Refinement::compare_quadrants(const Fragment& fragment, Decision& decision) const {
  if (fragment.level == 0) return;
  if (fragment.crosses_surfaces && !is_seen_alike(fragment)) {
    decision.verdict = Verdict::visibility;
  }
  const float limit = settings_.gradient_threshold * static_cast<float>(points_per_test());
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) {
      if (fragment.pixels[static_cast<std::size_t>(a)] == kNone ||
          fragment.pixels[static_cast<std::size_t>(b)] == kNone) {
        continue;
      }
      const Difference difference = difference_of(place_of(fragment, a), place_of(fragment, b));
      if (difference.bits >= bit_threshold(fragment.level)) decision.verdict = Verdict::visibility;
      // Gradients go around the fragment; quadrants across have none.
      const bool is_beside = b == a + 1 || (a == 0 && b == 3);
      if (is_beside && settings_.gradient_threshold >= 0.0F &&
          static_cast<float>(difference.gradient) > limit) {
        decision.quadrants_cut_again |= (1U << a) | (1U << b);
      }
    }
  }
}

/// Looks for what the quadrants' pixels missed at those that would be lit anyway.
void Refinement::compare_extras(const Fragment& fragment, Decision& decision) const {
  if (settings_.extra_from_level < 0 || fragment.level < settings_.extra_from_level) return;
  for (const std::int32_t pixel : extra_pixels(fragment, set_)) {
    const Place place{static_cast<std::size_t>(pixel), 0};
    const int quadrant = quadrant_of(fragment, {pixel % set_.width_px, pixel / set_.width_px});
    const Difference difference = difference_of(place, place_of(fragment, quadrant));
    if (difference.bits >= bit_threshold(fragment.level)) decision.verdict = Verdict::visibility;
  }
}

void Refinement::compare_ring(std::int32_t index, Decision& decision) const {
  const Fragment& fragment = set_.fragments[static_cast<std::size_t>(index)];
  const int step = std::max(1, fragment.side_px() / 2);
  // A pixel differs from coarser fragments only, and there is none in the block it was cut from.
  const int own_level = std::max(1, static_cast<int>(fragment.level));
  const glm::ivec2 own_block = fragment.corner() >> own_level;
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    const std::int32_t pixel = fragment.pixels[static_cast<std::size_t>(quadrant)];
    if (pixel == kNone) continue;
    const glm::ivec2 at(pixel % set_.width_px, pixel / set_.width_px);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const glm::ivec2 beside = at + step * glm::ivec2(dx, dy);
        if (set_.holds(beside) && beside >> own_level != own_block) {
          compare_with(index, quadrant, beside, decision);
        }
      }
    }
  }
}

/// Compares a quadrant with the one of another fragment that a pixel lies in.
void Refinement::compare_with(std::int32_t index, int quadrant, const glm::ivec2& at,
                              Decision& decision) const {
  const std::int32_t other_index = set_.at[set_.pixel(at.x, at.y)];
  if (other_index == kNone || other_index == index) return;
  const Fragment& fragment = set_.fragments[static_cast<std::size_t>(index)];
  const Fragment& other = set_.fragments[static_cast<std::size_t>(other_index)];
  if (other.is_culled || (fragment.level == 0 && other.level == 0)) return;
  // The coarser one is split, or both of a level; nothing is to be found out about the rest.
  const bool splits_this = fragment.level > 0 && fragment.level >= other.level;
  const bool splits_other = other.level > 0 && other.level >= fragment.level;
  if (!splits_other && decision.verdict == Verdict::visibility) return;
  const int other_quadrant = quadrant_of(other, at);
  const std::int32_t pixel = fragment.pixels[static_cast<std::size_t>(quadrant)];
  const std::int32_t other_pixel = other.pixels[static_cast<std::size_t>(other_quadrant)];
  if (other_pixel == kNone) return;
  if (difference_of(place_of(fragment, quadrant), place_of(other, other_quadrant)).bits <
      bit_threshold(std::max<int>(fragment.level, other.level))) {
    return;
  }
  if (!is_same_surface(surfaces_.pixels[static_cast<std::size_t>(pixel)],
                       surfaces_.pixels[static_cast<std::size_t>(other_pixel)],
                       settings_.same_surface)) {
    return;
  }
  if (splits_this) decision.verdict = Verdict::visibility;
  if (splits_other) decision.also_reopens.push_back(other_index);
}

/// Replaces a fragment by its parts; those of the marked quadrants are cut again.
void Refinement::split(std::int32_t index, unsigned quadrants_cut_again) {
  const Fragment fragment = set_.fragments[static_cast<std::size_t>(index)];
  label(fragment, kNone, set_);
  const bool is_test =
      set_.fragments[static_cast<std::size_t>(index)].state == Fragment::State::open &&
      !discontinuities_.is_discontinuous(fragment.level, fragment.x, fragment.y);
  int pieces = 0;
  const Parts parts = parts_of(fragment, set_);
  for (std::size_t i = 0; i < parts.count; ++i) {
    const bool is_cut = ((quadrants_cut_again >> parts.quadrants[i]) & 1U) != 0;
    if (!is_cut || fragment.level < 2) {
      add(parts.fragments[i]);
      ++pieces;
      continue;
    }
    const Parts finer = parts_of(parts.fragments[i], set_);
    for (std::size_t j = 0; j < finer.count; ++j) add(finer.fragments[j]);
    pieces += static_cast<int>(finer.count);
  }
  Fragment& kept = set_.fragments[static_cast<std::size_t>(index)];
  kept.state = Fragment::State::split;
  if (is_test) kept.pieces = static_cast<std::int8_t>(pieces);
}

}  // namespace

FragmentSet refine_fragments(ShadowTracer& tracer, const DiscontinuityPyramid& discontinuities,
                             const RefinementSettings& settings) {
  return Refinement(tracer, discontinuities, settings).run();
}

}  // namespace renderers::area_shadows

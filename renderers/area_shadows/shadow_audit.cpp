#include "renderers/area_shadows/shadow_audit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"

namespace renderers::area_shadows {

namespace {

constexpr std::size_t kPixelGrain = 64;
/// Difference of visible shares that is the border of a shadow, and the finest level at which a
/// fragment is too coarse for one.
constexpr float kContrast = 0.1F;
constexpr int kCoarseLevel = 3;
/// The share of pixels without a surface or unoccluded light.
constexpr float kNoShare = std::numeric_limits<float>::quiet_NaN();

struct PixelTruth {
  PixelIrradiance irradiance;
  std::vector<float> share;  ///< visible of the unoccluded light, mean of the channels with any
  std::uint64_t rays = 0;
};

float mean_share(const PixelLight& light) {
  const float open = light.open.x + light.open.y + light.open.z;
  if (open <= 0.0F) return kNoShare;
  return (light.irradiance.x + light.irradiance.y + light.irradiance.z) / open;
}

PixelTruth light_all_pixels(ShadowTracer& tracer) {
  const std::vector<PixelSurface>& surfaces = tracer.surfaces().pixels;
  PixelTruth truth{PixelIrradiance(surfaces.size(), glm::vec3(0.0F)),
                   std::vector<float>(surfaces.size(), kNoShare), 0};
  truth.rays = tracer.trace_pixels(surface_pixels(tracer.surfaces()));
  base::parallel_for(surfaces.size(), kPixelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      if (!surfaces[pixel].is_surface()) continue;
      const PixelLight light = tracer.light_of(pixel);
      truth.irradiance[pixel] = light.irradiance;
      truth.share[pixel] = mean_share(light);
    }
  });
  return truth;
}

/// Whether the shares in a box differ by more than the limit.
bool has_border(const PixelTruth& truth, const FragmentSet& set, const PixelBox& box) {
  float least = std::numeric_limits<float>::max();
  float greatest = std::numeric_limits<float>::lowest();
  for (int y = box.least.y; y < box.end.y; ++y) {
    for (int x = box.least.x; x < box.end.x; ++x) {
      const float share = truth.share[set.pixel(x, y)];
      if (std::isnan(share)) continue;
      least = std::min(least, share);
      greatest = std::max(greatest, share);
    }
  }
  return greatest - least > kContrast;
}

double crossed_blocks(const PixelTruth& truth, const AuditedPicture& picture) {
  Fragment block;
  block.level = static_cast<std::int8_t>(picture.coarsest_level);
  double count = 0.0;
  for (block.y = 0; block.corner().y < picture.set.height_px; ++block.y) {
    for (block.x = 0; block.corner().x < picture.set.width_px; ++block.x) {
      if (has_border(truth, picture.set, pixels_of(block, picture.set))) count += 1.0;
    }
  }
  return count;
}

/// Coarse fragments across a border, and the blocks that they lie in.
struct Missed {
  double fragments = 0.0;
  std::set<std::pair<int, int>> blocks;
};

Missed missed_borders(const PixelTruth& truth, const AuditedPicture& picture) {
  Missed missed;
  for (const Fragment& fragment : picture.set.fragments) {
    if (fragment.state != Fragment::State::final || fragment.level < kCoarseLevel ||
        !has_border(truth, picture.set, pixels_of(fragment, picture.set))) {
      continue;
    }
    missed.fragments += 1.0;
    const glm::ivec2 corner = fragment.corner();
    missed.blocks.emplace(corner.x >> picture.coarsest_level, corner.y >> picture.coarsest_level);
  }
  return missed;
}

double culled_lit_pixels(const PixelTruth& truth, const FragmentSet& set) {
  double count = 0.0;
  for (std::size_t pixel = 0; pixel < set.at.size(); ++pixel) {
    if (set.at[pixel] == kNone) continue;
    if (set.fragments[static_cast<std::size_t>(set.at[pixel])].is_culled &&
        truth.irradiance[pixel] != glm::vec3(0.0F)) {
      count += 1.0;
    }
  }
  return count;
}

/// Of the pixels of one kind of place.
struct PlaceError {
  double pixels = 0.0;
  double relative_rmse = 0.0;
};

PlaceError error_at(RbfPlace place, const PixelTruth& truth, const AuditedPicture& picture) {
  PlaceError error;
  double squares = 0.0;
  double light = 0.0;
  double lit = 0.0;
  for (std::size_t pixel = 0; pixel < truth.irradiance.size(); ++pixel) {
    if (std::isnan(truth.share[pixel])) continue;
    const glm::dvec3 exact(truth.irradiance[pixel]);
    light += (exact.x + exact.y + exact.z) / 3.0;
    lit += 1.0;
    if (picture.places[pixel] != place) continue;
    const glm::dvec3 difference = glm::dvec3(picture.irradiance[pixel]) - exact;
    squares += glm::dot(difference, difference) / 3.0;
    error.pixels += 1.0;
  }
  if (error.pixels > 0.0 && light > 0.0) {
    error.relative_rmse = std::sqrt(squares / error.pixels) / (light / lit);
  }
  return error;
}

}  // namespace

std::vector<std::pair<std::string, CounterValue>> audit_counters(ShadowTracer& tracer,
                                                                 const AuditedPicture& picture) {
  const PixelTruth truth = light_all_pixels(tracer);
  const Missed missed = missed_borders(truth, picture);
  const PlaceError enclosed = error_at(RbfPlace::enclosed, truth, picture);
  const PlaceError extrapolated = error_at(RbfPlace::extrapolated, truth, picture);
  return {{"audit_rays", static_cast<double>(truth.rays)},
          {"audit_crossed_blocks", crossed_blocks(truth, picture)},
          {"audit_missed_blocks", static_cast<double>(missed.blocks.size())},
          {"audit_missed_fragments", missed.fragments},
          {"audit_culled_lit_pixels", culled_lit_pixels(truth, picture.set)},
          {"enclosed_pixels", enclosed.pixels},
          {"extrapolated_pixels", extrapolated.pixels},
          {"enclosed_rmse", enclosed.relative_rmse},
          {"extrapolated_rmse", extrapolated.relative_rmse}};
}

}  // namespace renderers::area_shadows

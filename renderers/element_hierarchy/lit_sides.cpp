#include "renderers/element_hierarchy/lit_sides.h"

#include <algorithm>
#include <cassert>
#include <span>
#include <utility>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::element_hierarchy {

namespace {

using ray_tracing::SampleSequence;
using ray_tracing::SequenceKind;
using ray_tracing::SurfacePoint;

constexpr std::uint64_t kSeed = 0x51de;
/// Rays that must meet lit sides.
constexpr std::size_t kEnough = 2;
/// Of a side's rays at least this share, as one over it, where there are many; ours.
constexpr std::size_t kLeastShare = 16;
/// Cosine-distributed rays for one towards area lights; ours.
constexpr std::size_t kLampShare = 4;

class SideSearch {
 public:
  SideSearch(const ray_tracing::RayScene& rays, std::shared_ptr<const SurfacePieces> pieces,
             std::size_t rays_per_side)
      : rays_(rays),
        count_(rays_per_side),
        lamp_rays_(rays_per_side / kLampShare),
        lights_(rays),
        areas_(rays, ray_tracing::LightSet::hittable) {
    assert(count_ >= kEnough * kLampShare);
    found_.pieces = std::move(pieces);
    lit_.assign(2 * found_.pieces->count(), 0);
    seen_.resize(lit_.size() * count_);
    found_.lamps.resize(lit_.size());
  }

  LitSides run() {
    base::parallel_for(found_.pieces->count(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t side = 2 * begin; side < 2 * end; ++side) look_around(side);
    });
    spread();
    for (const std::uint8_t is_lit : lit_) found_.is_lit.push_back(is_lit != 0);
    found_.rays = seen_.size() + (areas_.is_empty() ? 0 : lamp_rays_ * lit_.size());
    found_.rays_per_side = count_;
    found_.seen = std::move(seen_);
    return std::move(found_);
  }

 private:
  struct Side {
    SurfacePieces::Piece piece;
    SurfacePoint middle;
    glm::vec3 normal;
  };
  Side side_at(std::size_t side) const {
    Side found{found_.pieces->at(side / 2), {}, {}};
    found.middle = point_on(found, {1.0F / 3.0F, 1.0F / 3.0F});
    found.normal = (side % 2 == 1 ? -1.0F : 1.0F) * found.middle.geometric_normal;
    return found;
  }
  /// @param weights  of the piece's second and third corner
  SurfacePoint point_on(const Side& side, const glm::vec2& weights) const {
    const auto& c = side.piece.corners;
    return rays_.point_on_triangle(side.piece.object, side.piece.triangle,
                                   c[0] + weights.x * (c[1] - c[0]) + weights.y * (c[2] - c[0]));
  }

  SeenSide side_met(const ray_tracing::LineHit& hit) const {
    const SurfacePieces::Place place =
        found_.pieces->place_of(hit.object, hit.triangle, hit.barycentrics);
    const glm::vec2 weights(place.weights.y, place.weights.z);
    return {static_cast<std::uint32_t>(2 * place.piece + (hit.looks_back ? 0 : 1)),
            glm::u16vec2(65535.0F * glm::clamp(weights, 0.0F, 1.0F) + 0.5F)};
  }
  /// The balance heuristic's weight (`SeenLamp`) of a cosine-distributed ray; that of a ray towards
  /// a lamp is the rest to 1. @param by_cosine, by_lamp  densities, 1/sr
  float cosine_weight(float by_cosine, float by_lamp) const {
    const float rays = static_cast<float>(count_) * by_cosine;
    return rays / (rays + static_cast<float>(lamp_rays_) * by_lamp);
  }

  /// What a cosine-distributed ray meets. @param u  in [0, 1)^4  @param lamps  receives a light
  SeenSide look(const Side& side, const glm::vec4& u, std::vector<SeenLamp>& lamps) const {
    const SurfacePoint from = point_on(side, ray_tracing::uniform_triangle({u.z, u.w}));
    const glm::vec3 direction =
        ray_tracing::frame_around(side.normal).to_world(ray_tracing::cosine_hemisphere({u.x, u.y}));
    ray_tracing::LineHit hit;
    if (!rays_.nearest(ray_from(from, direction), hit)) return {};
    const SeenSide met = side_met(hit);
    if (hit.looks_back && is_emissive(hit.object)) {
      ray_tracing::Hit point;
      static_cast<SurfacePoint&>(point) =
          rays_.point_on_triangle(hit.object, hit.triangle, hit.barycentrics);
      const float by_lamp = areas_.pdf_of_emission(point, direction, hit.t);
      const float by_cosine = glm::dot(direction, side.normal) / ray_tracing::kPi;
      lamps.push_back({met, cosine_weight(by_cosine, by_lamp) / static_cast<float>(count_)});
    }
    return met;
  }
  bool is_emissive(std::uint32_t object) const {
    const scene::Scene& scene = rays_.scene();
    return scene.materials[static_cast<std::size_t>(scene.objects[object].material)].is_emissive();
  }

  void look_around(std::size_t index) {
    const Side side = side_at(index);
    if (!(side.piece.area_m2 > 0.0F)) return;
    if (index % 2 == 0 && is_emissive(side.piece.object)) lit_[index] = 1;
    if (sees_point_light(side.middle, side.normal)) lit_[index] = 1;
    const std::uint64_t seed = ray_tracing::hash_combine(kSeed, index);
    const std::size_t seen = look_for_lamps(index, side, seed);
    if (seen >= std::max(kEnough, lamp_rays_ / kLeastShare)) lit_[index] = 1;
    for (std::size_t i = 0; i < count_; ++i) {
      const glm::vec4 u =
          SampleSequence(SequenceKind::sobol, seed, static_cast<std::uint32_t>(i)).next();
      seen_[index * count_ + i] = look(side, u, found_.lamps[index]);
      if (seen_[index * count_ + i].side == kNoSide && rays_.scene().environment) lit_[index] = 1;
    }
  }

  /// @return how many of its lamp rays see their light
  std::size_t look_for_lamps(std::size_t index, const Side& side, std::uint64_t seed) {
    std::size_t seen = 0;
    for (std::size_t i = 0; i < lamp_rays_ && !areas_.is_empty(); ++i) {
      SampleSequence numbers(SequenceKind::sobol, ray_tracing::hash_combine(seed, kSeed),
                             static_cast<std::uint32_t>(i));
      const glm::vec4 u = numbers.next();
      const SurfacePoint from = point_on(side, ray_tracing::uniform_triangle({u.x, u.y}));
      const auto sample = areas_.sample(from, {u.z, u.w, numbers.next().x});
      if (!sample) continue;
      const float cosine = glm::dot(sample->direction, side.normal);
      if (cosine <= 0.0F || rays_.is_occluded(sample->shadow_ray)) continue;
      if (sample->radiance != glm::vec3(0.0F)) ++seen;
      ray_tracing::LineHit hit;
      // Nothing: the environment. Dark texels count, as a leaf's radiosity is a mean over them.
      if (!rays_.nearest(ray_from(from, sample->direction), hit)) continue;
      if (!hit.looks_back || !is_emissive(hit.object)) continue;
      const float by_cosine = cosine / ray_tracing::kPi;
      const float weight = 1.0F - cosine_weight(by_cosine, sample->pdf);
      found_.lamps[index].push_back(
          {side_met(hit), weight * by_cosine / (sample->pdf * static_cast<float>(lamp_rays_))});
    }
    return seen;
  }

  bool sees_point_light(const SurfacePoint& point, const glm::vec3& normal) const {
    for (const scene::Light& light : rays_.scene().lights) {
      const auto sample = lights_.sample_point_light(light, point);
      if (!sample || sample->radiance == glm::vec3(0.0F)) continue;
      if (glm::dot(sample->direction, normal) <= 0.0F) continue;
      if (!rays_.is_occluded(sample->shadow_ray)) return true;
    }
    return false;
  }

  bool sees_lit_ones(std::size_t side) const {
    const auto own = std::span(seen_).subspan(side * count_, count_);
    const auto met = std::ranges::count_if(
        own, [&](const SeenSide& view) { return view.side != kNoSide && lit_[view.side] != 0; });
    return static_cast<std::size_t>(met) >= std::max(kEnough, count_ / kLeastShare);
  }

  /// Until nothing changes; the result does not depend on the order.
  void spread() {
    std::vector<std::uint8_t> becomes_lit(lit_.size());
    for (bool has_changed = true; has_changed;) {
      base::parallel_for(lit_.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          becomes_lit[i] = lit_[i] == 0 && sees_lit_ones(i) ? 1 : 0;
        }
      });
      has_changed = false;
      for (std::size_t i = 0; i < lit_.size(); ++i) {
        if (becomes_lit[i] == 0) continue;
        lit_[i] = 1;
        has_changed = true;
      }
    }
  }

  const ray_tracing::RayScene& rays_;
  std::size_t count_;      ///< rays per side
  std::size_t lamp_rays_;  ///< and towards area lights
  ray_tracing::LightSampler lights_;
  ray_tracing::LightSampler areas_;  ///< and environment
  LitSides found_;
  std::vector<std::uint8_t> lit_;  ///< per side; bytes, as threads write neighbours
  std::vector<SeenSide> seen_;     ///< [side][ray]
};

}  // namespace

LitSides find_lit_sides(const ray_tracing::RayScene& rays,
                        std::shared_ptr<const SurfacePieces> pieces, std::size_t rays_per_side) {
  return SideSearch(rays, std::move(pieces), rays_per_side).run();
}

}  // namespace renderers::element_hierarchy

#pragma once

#include <atomic>
#include <cstdint>

#include "renderers/contract/renderer.h"
#include "renderers/irradiance_cache/bounce_light.h"
#include "renderers/irradiance_cache/irradiance_records.h"

namespace renderers::irradiance_cache {

struct CacheSettings {
  RecordSettings records;
  GridSize grid;
  SpacingBounds spacing;
  int depth = 0;  ///< of `BounceLight`
};

/// Indirect light from records that are made where a picture needs them.
class CachedLight final : public indirect_view::IndirectLight {
 public:
  /// @param rays  must live as long as this
  CachedLight(const ray_tracing::RayScene& rays, const CacheSettings& settings);

  /// Makes records at the pixels' centres of a picture, coarse to fine, until each is in reach of
  /// one. Pixels are taken in a fixed order by groups whose records are made at once and inserted
  /// one after the other, so that they do not depend on the number of threads.
  /// @param seed  of the records' rays
  void fill(const RenderJob& job, std::uint64_t seed);

  /// From the records, within a larger reach than those of `fill`; where there is none, by a
  /// hemisphere of its own, which is not kept.
  glm::vec3 irradiance(const indirect_view::ViewedPoint& point, std::uint64_t& rays) const override;
  glm::vec3 reflected(const indirect_view::ViewedPoint& point, std::uint64_t& rays) const override;

  const IrradianceRecords& records() const { return records_; }
  std::uint64_t record_rays() const { return record_rays_; }
  std::uint64_t discarded() const { return discarded_; }  ///< made in vain: another was in reach
  std::uint64_t uncovered() const { return uncovered_; }  ///< points without a record in reach

 private:
  IrradianceRecord record_at(const indirect_view::ViewedPoint& point, std::uint64_t& cast) const;

  const ray_tracing::RayScene& rays_;
  CacheSettings settings_;
  BounceLight bounces_;
  IrradianceRecords records_;
  std::uint64_t record_rays_ = 0;
  std::uint64_t discarded_ = 0;
  mutable std::atomic<std::uint64_t> uncovered_ = 0;
};

}  // namespace renderers::irradiance_cache

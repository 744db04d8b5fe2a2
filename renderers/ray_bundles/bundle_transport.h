#pragma once

#include <cassert>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/contract/stage_timer.h"
#include "renderers/opengl/context.h"
#include "renderers/ray_bundles/bundle_lists.h"
#include "renderers/ray_bundles/bundle_raster.h"
#include "renderers/ray_bundles/direction_set.h"
#include "renderers/ray_bundles/glossy_transfer.h"
#include "renderers/ray_bundles/glossy_view.h"
#include "renderers/ray_bundles/gpu_bundle_lists.h"
#include "renderers/ray_bundles/gpu_exchange.h"
#include "renderers/ray_bundles/light_solution.h"
#include "renderers/ray_bundles/path_census.h"
#include "renderers/ray_bundles/radiance_exchange.h"
#include "renderers/ray_bundles/texture_detail.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/texel_atlas/texel_atlas.h"

namespace renderers::ray_bundles {

enum class TransferMode { gather, scatter };

/// How the crossings of a bundle's lines are found.
enum class ListKind {
  raster,   ///< triangles are drawn, their fragments counted first: `BundleRaster::fill`, or the
            ///< same of `GpuBundleLists`
  fixed_k,  ///< triangles are drawn into a k-buffer: `fill_slots` of these
  trace     ///< lines are traced: `trace_lists`, or the same of `GpuBundleLists`
};

/// Where light is exchanged.
enum class ExchangePlace {
  automatic,  ///< `device` if that is hardware and can (`can_exchange_on_device`), until its
              ///< storage blocks do not hold a bundle; else `cpu`
  cpu,
  device
};

struct TransportSettings {
  DirectionKind directions = DirectionKind::halton_permuted;
  double importance = 0.0;  ///< share of the directions drawn by `measure_importance`
  ListKind lists = ListKind::raster;
  SlotSettings slots;                                 ///< fixed_k only
  std::shared_ptr<opengl::Context> device;            ///< finds crossings; null: the CPU does
  ExchangePlace exchange = ExchangePlace::automatic;  ///< device: not without one
  TransferMode mode = TransferMode::scatter;
  bool textures_at_points = true;  ///< of senders: `TextureDetail`; or means over texels
  /// For tests: bytes of the device's storage blocks, 0: its own; `automatic` takes software, too.
  std::int64_t most_block_bytes = 0;
  bool takes_software = false;
  int lines_across = 384;
  std::uint64_t seed = 1;
  std::int64_t planned = 0;   ///< directions; 0: not known
  std::int64_t set_size = 0;  ///< of complete sets of directions; 0: as many as planned
  int census = 0;             ///< most reflections of paths that are counted apart; 0: none are
  SolutionSettings solution;
};

/// True for what `GpuExchange` can do in scenes whose senders have no detail.
bool can_exchange_on_device(const TransportSettings& settings);

struct TransportCounts {
  std::uint64_t lines = 0;
  std::uint64_t nodes = 0;
  /// Times the geometry was drawn or traced, once for the exchange included.
  std::uint64_t passes = 0;
  std::uint64_t dropped = 0;  ///< crossings missing from the lists
  ExchangeCounts exchange;
};

/// Casts bundle after bundle and lets each exchange its radiance.
///
/// Source: Hermes et al. 2010, Fig. 3.
class BundleTransport {
 public:
  /// @param rays   with RayQueries::all_hits if the CPU traces the lines; must live as long as
  ///               this, as must the atlas
  /// @param timer  stages `bvh` and `upload` under whatever stage is open if the device traces them
  BundleTransport(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
                  const TransportSettings& settings, StageTimer& timer);

  /// Direct light known beforehand, J per side.
  void set_known_direct(std::vector<glm::vec3> incident) {
    solution_.set_known_direct(std::move(incident));
  }
  /// Aims the share `importance` of the directions, by the light known now; before the first of
  /// them. Stage `importance` under whatever stage is open.
  void aim(StageTimer& timer);
  BundleTransport(BundleTransport&&) = default;  // what its parts refer to stays where it is
  BundleTransport(const BundleTransport&) = delete;
  BundleTransport& operator=(const BundleTransport&) = delete;

  /// The next direction. Stages `visibility` (the lists), `transport` (the exchange; on the device
  /// `transport/exchange`) and, with a view, `gather`. @param view  looks at the bundle before it
  /// changes the solution; may be null
  void add_direction(StageTimer& timer, GlossyView* view = nullptr);

  /// Why the CPU exchanges light that a device began with; empty: it does not.
  const std::string& note() const { return note_; }

  /// Brings the solution and the counts from the device, if they are there: before anybody looks.
  /// Stage `fetch` under whatever stage is open.
  void fetch(StageTimer& timer);

  const TransportSettings& settings() const { return settings_; }
  std::int64_t directions() const { return solution_.directions(); }
  /// Not before `fetch`, as the counts.
  const LightSolution& solution() const {
    assert(is_fetched_);
    return solution_;
  }
  const TransportCounts& counts() const {
    assert(is_fetched_);
    return counts_;
  }
  std::int64_t memory_bytes() const {
    return solution_.memory_bytes() + (detail_ ? detail_->memory_bytes() : 0) +
           (directed_ ? directed_->memory_bytes() : 0) +
           (gpu_lists_ ? gpu_lists_->memory_bytes() : 0) +
           (gpu_exchange_ ? gpu_exchange_->memory_bytes() : 0) +
           (census_ ? census_->memory_bytes() : 0);
  }
  /// `PathCensus::means`; empty without a census.
  std::vector<double> light_by_reflections() const {
    return census_ ? census_->means(solution_) : std::vector<double>();
  }
  /// Null without `glossy_chain`.
  const GlossyTransfer* glossy() const { return glossy_.get(); }

 private:
  glm::vec3 direction_after(const glm::vec3& direction);
  void fill_lists(const BundleFrame& frame, StageTimer& timer);
  void build_lists(StageTimer& timer);
  SlotCounts draw_lists(const BundleFrame& frame, StageTimer& timer);
  bool add_on_device(const Bundle& bundle, StageTimer& timer);
  void exchange_on_device(const Bundle& bundle, StageTimer& timer);
  ExchangeCounts exchange(const Bundle& bundle, LightSolution& solution);
  EndLight end_light(const glm::vec3& direction) const;

  const ray_tracing::RayScene& rays_;
  const texel_atlas::TexelAtlas& atlas_;
  TransportSettings settings_;
  scene::Box box_;
  DirectionSet directions_;
  BundleLists lists_;
  std::optional<BundleRaster> raster_;         ///< nothing: not of this
  std::unique_ptr<GpuBundleLists> gpu_lists_;  ///< null: not of this
  bool is_on_device_ = false;                  ///< the exchange
  bool is_fetched_ = true;
  std::string note_;
  std::unique_ptr<GpuExchange> gpu_exchange_;  ///< null: not of this, or not yet
  std::optional<TextureDetail> detail_;        ///< nothing: means
  std::optional<DirectedEmission> directed_;   ///< nothing: no emission depends on the direction
  std::vector<ExchangeTexel> texels_;
  Scatter scatter_;
  LightSolution solution_;
  std::optional<PathCensus> census_;
  std::unique_ptr<GlossyTransfer> glossy_;
  TransportCounts counts_;
};

}  // namespace renderers::ray_bundles

#include "renderers/ray_bundles/bundle_transport.h"

#include <cassert>
#include <utility>

#include <fmt/core.h>

#include "renderers/opengl/gpu_stage.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::ray_bundles {

namespace {

/// Sets the random numbers of the importance apart from those of the directions.
constexpr std::uint64_t kImportanceNumbers = 0x696d706f7274ULL;

}  // namespace

bool can_exchange_on_device(const TransportSettings& settings) {
  const FeedKind feed = settings.solution.feed;
  return settings.mode == TransferMode::scatter && settings.census == 0 &&
         !settings.solution.glossy_chain &&
         (feed == FeedKind::growing_step || feed == FeedKind::running_mean);
}

BundleTransport::BundleTransport(const ray_tracing::RayScene& rays,
                                 const texel_atlas::TexelAtlas& atlas,
                                 const TransportSettings& settings, StageTimer& timer)
    : rays_(rays),
      atlas_(atlas),
      settings_(settings),
      box_{rays.box_min(), rays.box_max()},
      directions_(settings.directions, settings.seed, settings.planned, settings.set_size),
      texels_(exchange_texels(atlas)),
      scatter_(texels_),
      solution_(atlas, settings.solution) {
  build_lists(timer);
  if (settings.textures_at_points) {
    detail_.emplace(rays, atlas);
    if (detail_->is_empty()) detail_.reset();
  }
  if (solution_.brings_emission()) {
    directed_.emplace(rays, atlas);
    if (directed_->is_empty()) directed_.reset();
    if (directed_) directed_->apply(solution_);
  }
  const bool is_asked_for = settings.exchange == ExchangePlace::device;
  if (is_asked_for && detail_) {
    throw UnsupportedError(
        "ray-bundles: exchange device with textures point in a scene that has textures; accepted: "
        "textures texel, or exchange cpu");
  }
  is_on_device_ = settings.device && !detail_ && can_exchange_on_device(settings) &&
                  (is_asked_for || (settings.exchange == ExchangePlace::automatic &&
                                    (settings.takes_software || !settings.device->is_software())));
  if (settings.census > 0) census_.emplace(atlas, settings.solution, settings.census);
  if (settings.solution.glossy_chain) {
    glossy_ = std::make_unique<GlossyTransfer>(rays, atlas, settings.solution.has_back_sides);
    solution_.set_glossy(glossy_.get());
  }
}

/// What will find the crossings; lines that the CPU traces need nothing more.
void BundleTransport::build_lists(StageTimer& timer) {
  const bool is_traced = settings_.lists == ListKind::trace;
  if (is_traced && !settings_.device) return;
  const texel_atlas::WorldTriangles world = texel_atlas::world_triangles(rays_.scene());
  if (!settings_.device) {
    raster_.emplace(world, atlas_);
    return;
  }
  gpu_lists_ =
      std::make_unique<GpuBundleLists>(settings_.device, world, atlas_, settings_.most_block_bytes);
  if (is_traced) gpu_lists_->use_rays(world, atlas_, timer);
}

void BundleTransport::aim(StageTimer& timer) {
  if (settings_.importance <= 0.0 || atlas_.texels().empty()) return;
  const auto stage = timer.stage("importance");
  CarriedLight light;
  light.has_environment = solution_.brings_emission();
  light.seed = ray_tracing::hash_combine(settings_.seed, kImportanceNumbers);
  const auto sides = static_cast<std::uint32_t>(2 * atlas_.texels().size());
  light.radiance.reserve(sides);
  for (std::uint32_t side = 0; side < sides; ++side) {
    light.radiance.push_back(solution_.emitted(side) + solution_.reflected(side));
  }
  directions_.set_importance(measure_importance(rays_, atlas_, light), settings_.importance);
}

void BundleTransport::add_direction(StageTimer& timer, GlossyView* view) {
  if (atlas_.texels().empty()) {
    solution_.begin_direction();
    solution_.end_direction();
    return;
  }
  const BundleDirection direction = directions_.at(solution_.directions());
  const BundleFrame frame(box_, direction, settings_.lines_across);
  counts_.lines += frame.line_count();
  if (directed_) {
    directed_->turn(frame.direction);
    directed_->apply(solution_);
  }
  const Bundle bundle{frame,
                      lists_,
                      end_light(frame.direction),
                      detail_ ? &*detail_ : nullptr,
                      directed_ ? &*directed_ : nullptr,
                      direction.weight};
  assert(!is_on_device_ || view == nullptr);
  if (is_on_device_ && add_on_device(bundle, timer)) return;
  {
    const auto stage = timer.stage("visibility");
    fill_lists(frame, timer);
  }
  if (view != nullptr) {
    const auto stage = timer.stage("gather");
    view->add(bundle, solution_);
  }
  const auto stage = timer.stage("transport");
  if (glossy_) glossy_->begin_direction(frame.direction, direction_after(frame.direction));
  if (census_) {
    census_->add_direction(solution_, direction.weight,
                           [&](LightSolution& length) { exchange(bundle, length); });
  }
  solution_.begin_direction(direction.weight);
  counts_.exchange.add(exchange(bundle, solution_));
  solution_.end_direction();
  counts_.nodes += lists_.node_count();
}

/// @return false if the device refuses what nobody asked of it: from here on the CPU exchanges
bool BundleTransport::add_on_device(const Bundle& bundle, StageTimer& timer) {
  try {
    {
      const auto stage = timer.stage("visibility");
      fill_lists(bundle.frame, timer);
    }
    exchange_on_device(bundle, timer);
    return true;
  } catch (const UnsupportedError& error) {
    if (settings_.exchange == ExchangePlace::device) throw;
    note_ = fmt::format("exchange auto: the CPU exchanges light from direction {} on: {}",
                        solution_.directions(), error.what());
  }
  const auto stage = timer.stage("transport");
  fetch(timer);
  gpu_exchange_.reset();
  is_on_device_ = false;
  return false;
}

void BundleTransport::exchange_on_device(const Bundle& bundle, StageTimer& timer) {
  const auto stage = timer.stage("transport");
  const opengl::GpuStage inner(*settings_.device, timer, "exchange");
  if (!gpu_exchange_) {
    std::vector<glm::vec3> albedos;
    for (const texel_atlas::Texel& texel : atlas_.texels()) albedos.push_back(texel.albedo);
    gpu_exchange_ = std::make_unique<GpuExchange>(settings_.device, texels_, albedos, solution_);
  }
  if (directed_) gpu_exchange_->set_emitted(solution_);
  solution_.begin_direction(bundle.weight);
  counts_.nodes +=
      gpu_exchange_->exchange(*gpu_lists_, bundle.frame, bundle.ends, bundle.weight, solution_);
  solution_.end_direction();
  is_fetched_ = false;
}

void BundleTransport::fetch(StageTimer& timer) {
  if (is_fetched_) return;
  const auto stage = timer.stage("fetch");
  gpu_exchange_->fetch(solution_);
  counts_.exchange = gpu_exchange_->counts();
  is_fetched_ = true;
}

ExchangeCounts BundleTransport::exchange(const Bundle& bundle, LightSolution& solution) {
  return settings_.mode == TransferMode::gather ? gather(texels_, bundle, solution)
                                                : scatter_.exchange(bundle, solution);
}

/// Nothing follows the last planned direction; what is sent along it is never received.
glm::vec3 BundleTransport::direction_after(const glm::vec3& direction) {
  const std::int64_t next = solution_.directions() + 1;
  const bool is_last = settings_.planned > 0 && next >= settings_.planned;
  return is_last ? direction : directions_.at(next).direction;
}

void BundleTransport::fill_lists(const BundleFrame& frame, StageTimer& timer) {
  if (settings_.lists == ListKind::trace && !gpu_lists_) {
    trace_lists(rays_, atlas_, frame, lists_);
    counts_.passes += 2;
    return;
  }
  const SlotCounts counts = draw_lists(frame, timer);
  counts_.passes += counts.passes + 1;
  counts_.dropped += counts.dropped;
}

SlotCounts BundleTransport::draw_lists(const BundleFrame& frame, StageTimer& timer) {
  const bool has_slots = settings_.lists == ListKind::fixed_k;
  if (is_on_device_) return gpu_lists_->keep(frame, has_slots ? &settings_.slots : nullptr, timer);
  if (gpu_lists_) {
    return has_slots ? gpu_lists_->fill_slots(frame, settings_.slots, lists_, timer)
                     : gpu_lists_->fill(frame, lists_, timer);
  }
  if (has_slots) return raster_->fill_slots(frame, settings_.slots, lists_);
  raster_->fill(frame, lists_);
  return {1, 0};
}

EndLight BundleTransport::end_light(const glm::vec3& direction) const {
  const scene::Scene& scene = rays_.scene();
  if (!scene.environment) return {};
  return {scene::sample_environment(*scene.environment, direction),
          scene::sample_environment(*scene.environment, -direction)};
}

}  // namespace renderers::ray_bundles

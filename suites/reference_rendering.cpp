#include "suites/reference_rendering.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "perception/base/available_memory.h"
#include "perception/base/parallel.h"
#include "suites/picture_memory.h"

namespace suites {
namespace {

/// Pixels times samples of one piece: a few seconds of path tracing on two cores.
constexpr std::int64_t kChunkWork = std::int64_t{1} << 23;
constexpr std::int64_t kMinChunkSamples = 16;
constexpr std::int64_t kMaxChunkSamples = 256;

/// `above` over `below`, weighted.
void blend(perception::Image& sum, const perception::Image& piece, double sum_weight,
           double piece_weight) {
  if (piece.is_empty()) sum = perception::Image{};
  for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
    sum.pixels[i] = static_cast<float>(sum_weight * static_cast<double>(sum.pixels[i]) +
                                       piece_weight * static_cast<double>(piece.pixels[i]));
  }
}

perception::Image aov(const renderers::Frame& frame, const std::string& name) {
  for (const perception::NamedImage& image : frame.aovs) {
    if (image.name == name) return perception::rgb_of(image.image);
  }
  return {};
}

/// Those that a reference does not keep as parts of its own.
std::vector<perception::NamedImage> other_aovs(const renderers::Frame& frame) {
  std::vector<perception::NamedImage> others;
  for (const perception::NamedImage& image : frame.aovs) {
    if (image.name != "indirect" && image.name != "variance") others.push_back(image);
  }
  return others;
}

/// @throws base::InputError for a size that no memory is left for
void check_memory(const ReferenceKey& key) {
  // All light, indirect light and variance; an own reference may have no such parts.
  const std::size_t channels = key.spec.own ? 3 : 9;
  // Of the renderer, and of the estimate that its pieces are added to.
  constexpr std::size_t kCopies = 2;
  const auto lack = lack_of_memory(key.size_px, channels, kCopies, base::available_memory_bytes());
  if (lack) throw base::InputError("reference: " + *lack);
}

void set_if_declared(base::Parameters& parameters, const char* name, base::ParameterValue value) {
  if (parameters.contains(name)) parameters.set(name, std::move(value));
}

/// The renderer of a reference by sampling, set to the claims.
MethodChoice sampled_method(const ReferenceKey& key) {
  const base::Place place{"reference", 0, 0};
  MethodChoice method;
  method.info = &renderers::find_renderer(key.spec.renderer, place);
  method.preset = "best";
  method.parameters = base::resolve_parameters(
      method.info->parameters, &renderers::find_preset(*method.info, "best", place), {},
      fmt::format("renderer \"{}\"", method.info->name));
  set_if_declared(method.parameters, "transport", to_string(key.claims.transport));
  set_if_declared(method.parameters, "part", to_string(renderers::Part::all));
  set_if_declared(method.parameters, "geometry_clamp", key.claims.geometry_clamp.value_or(0.0));
  if (method.info->claims(method.parameters, *key.scene) != key.claims) {
    throw base::InputError(fmt::format(
        "reference: renderer \"{}\" cannot render transport {} with geometry_clamp {}; a reference "
        "needs a renderer with the parameters transport and geometry_clamp, e.g. path",
        method.info->name, to_string(key.claims.transport), key.claims.geometry_clamp.value_or(0)));
  }
  return method;
}

}  // namespace

MethodChoice reference_method(const ReferenceKey& key) {
  MethodChoice method = key.spec.own ? key.spec.own->choice : sampled_method(key);
  const auto lacking = renderers::unsupported_features(*method.info, *key.scene);
  if (!lacking.empty()) {
    throw base::InputError(fmt::format("reference: renderer \"{}\" does not support {} of scene {}",
                                       method.info->name, fmt::join(lacking, ", "),
                                       key.scene->name));
  }
  return method;
}

std::int64_t chunk_samples(base::SizePx size_px) {
  const auto pixels =
      static_cast<std::uint64_t>(size_px.width) * static_cast<std::uint64_t>(size_px.height);
  const std::uint64_t samples =
      std::bit_floor(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(kChunkWork) / pixels));
  return std::clamp(static_cast<std::int64_t>(samples), kMinChunkSamples, kMaxChunkSamples);
}

std::int64_t piece_samples(std::int64_t left, std::int64_t at_once) {
  return left < at_once + kMinChunkSamples ? left : at_once;
}

ReferenceRenderer::ReferenceRenderer(const ReferenceKey& key, const renderers::Devices& devices)
    : key_(key), devices_(devices), method_(reference_method(key)) {
  check_memory(key);
  const base::ThreadLimit limit(devices.threads);
  renderer_ = method_.info->create(method_.parameters, devices_);
  renderer_->prepare(*key.scene, timer_);
}

ReferenceRenderer::~ReferenceRenderer() = default;

ReferenceEstimate ReferenceRenderer::render(std::int64_t samples, std::uint64_t seed) {
  const base::ThreadLimit limit(devices_.threads);
  renderers::RenderJob job;
  job.width_px = key_.size_px.width;
  job.height_px = key_.size_px.height;
  job.camera = key_.scene->camera;
  job.seed = seed;
  job.frame_index = key_.scene->frame_index;
  if (method_.info->progressive_unit) job.samples = samples;
  renderers::Frame frame = renderer_->render(job, timer_);
  const perception::NonFinite bad = perception::count_non_finite(frame.radiance);
  if (bad.pixels > 0) {
    throw base::DeviceError(
        fmt::format("reference of {}: {} pixels are not finite, the first at ({}, {})",
                    key_.scene->name, bad.pixels, bad.first_x_px, bad.first_y_px));
  }
  ReferenceEstimate estimate;
  estimate.indirect = aov(frame, "indirect");
  estimate.variance = aov(frame, "variance");
  estimate.all = perception::rgb_of(frame.radiance);
  if (key_.spec.own) estimate.aovs = other_aovs(frame);
  estimate.samples = method_.info->progressive_unit ? frame.samples : samples;
  return estimate;
}

void merge(ReferenceEstimate& sum, const ReferenceEstimate& piece) {
  if (sum.samples == 0) {
    sum = piece;
    return;
  }
  const std::int64_t samples = sum.samples + piece.samples;
  const double a = static_cast<double>(sum.samples) / static_cast<double>(samples);
  const double b = static_cast<double>(piece.samples) / static_cast<double>(samples);
  blend(sum.all, piece.all, a, b);
  blend(sum.indirect, piece.indirect, a, b);
  blend(sum.variance, piece.variance, a * a, b * b);
  sum.samples = samples;
}

}  // namespace suites

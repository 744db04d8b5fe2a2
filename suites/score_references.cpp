#include "suites/score_references.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "perception/base/errors.h"

namespace suites {
namespace {

/// References that stay loaded: two of a frame, and what the methods of a scene claim besides.
constexpr std::size_t kMostLoaded = 4;

/// Seed of the noise that is laid over a reference for its noise floor.
constexpr std::uint64_t kNoiseSeed = 1;

}  // namespace

std::shared_ptr<const Reference> ScoreReferences::find(std::size_t reference) {
  const auto found = std::find_if(loaded_.begin(), loaded_.end(),
                                  [&](const auto& entry) { return entry.first == reference; });
  if (found != loaded_.end()) {
    loaded_.splice(loaded_.begin(), loaded_, found);
    return loaded_.front().second;
  }
  const ReferenceKey key = reference_key(plan_.references[reference]);
  std::shared_ptr<const Reference> loaded;
  if (store_.contains(key)) {
    if (std::optional<Reference> stored = store_.load(key)) {
      loaded = std::make_shared<const Reference>(std::move(*stored));
    }
  }
  loaded_.emplace_front(reference, std::move(loaded));
  if (loaded_.size() > kMostLoaded) loaded_.pop_back();
  return loaded_.front().second;
}

std::shared_ptr<const Reference> ScoreReferences::get(const ReferencePart& truth) {
  std::shared_ptr<const Reference> reference = find(truth.reference);
  if (reference == nullptr) throw base::InputError("there is no reference with enough samples");
  if (reference->image(truth.part).is_empty()) {
    throw base::InputError("the reference's renderer keeps no indirect part");
  }
  return reference;
}

bool has_variance(const Reference& reference, renderers::Part part) {
  return part == renderers::Part::all && !reference.variance.is_empty();
}

std::optional<double> noise_floor(const Reference& reference, renderers::Part part,
                                  const metrics::MetricChoice& choice,
                                  const perception::ViewingConditions& viewing,
                                  const perception::Image* mask) {
  if (!has_variance(reference, part)) return std::nullopt;
  const perception::Image noisy = perturbed(reference, kNoiseSeed);
  const double value =
      metrics::score(choice, {reference.all, noisy, nullptr, mask}, viewing, {false, false}).value;
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

perception::Image perturbed(const Reference& reference, std::uint64_t seed) {
  perception::Image image = reference.all;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const std::size_t channels = image.channels.size();
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    const double draw = normal(random);
    for (std::size_t i = pixel * channels; i < (pixel + 1) * channels; ++i) {
      const double sigma = std::sqrt(std::max(0.0F, reference.variance.pixels[i]));
      image.pixels[i] += static_cast<float>(sigma * draw);
    }
  }
  return image;
}

}  // namespace suites

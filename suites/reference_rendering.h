#pragma once

#include <cstdint>
#include <memory>

#include "perception/image.h"
#include "suites/measurement.h"
#include "suites/reference_images.h"

namespace suites {

/// An estimate of a reference: means over `samples` and the variance of those means.
struct ReferenceEstimate {
  perception::Image all;
  perception::Image indirect;                ///< empty if the renderer has no AOV "indirect"
  perception::Image variance;                ///< empty if the renderer has no AOV "variance"
  std::vector<perception::NamedImage> aovs;  ///< of an own picture, but those two
  std::int64_t samples = 0;
};

/// The renderer of a reference: its own picture's, or one with preset `best` and the transport and
/// clamp that are asked for.
/// @throws base::InputError if the renderer cannot render them, or not this scene
MethodChoice reference_method(const ReferenceKey& key);

/// Progressive units of one independent piece of a reference: about as much work for every size, so
/// that an interruption loses little.
std::int64_t chunk_samples(base::SizePx size_px);

/// Samples of the next piece when `left` are to be made, at most `at_once` where that is possible:
/// a remainder too small to tell its own variance is taken along.
std::int64_t piece_samples(std::int64_t left, std::int64_t at_once);

/// Renders independent pieces of one reference; the scene is prepared once.
class ReferenceRenderer {
 public:
  /// @throws base::InputError, base::DeviceError
  ReferenceRenderer(const ReferenceKey& key, const renderers::Devices& devices);
  ~ReferenceRenderer();

  const MethodChoice& method() const { return method_; }
  /// @throws base::DeviceError if the image holds non-finite pixels
  ReferenceEstimate render(std::int64_t samples, std::uint64_t seed);

 private:
  ReferenceKey key_;
  renderers::Devices devices_;
  MethodChoice method_;
  std::unique_ptr<renderers::Renderer> renderer_;
  renderers::StageTimer timer_;
};

/// Joins two independent estimates, weighted by samples: m = w1 m1 + w2 m2,
/// var m = w1^2 var m1 + w2^2 var m2 with w = samples / all samples.
void merge(ReferenceEstimate& sum, const ReferenceEstimate& piece);

}  // namespace suites

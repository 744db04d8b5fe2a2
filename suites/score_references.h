#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <utility>

#include "suites/reference_images.h"
#include "suites/run_plan.h"
#include "suites/score_plan.h"

namespace suites {

/// The references of a plan, loaded when they are asked for; those asked for last stay at hand.
class ScoreReferences {
 public:
  /// @param plan, store  must outlive this object
  ScoreReferences(const RunPlan& plan, const ReferenceStore& store) : plan_(plan), store_(store) {}

  /// Null if there is none with as many samples as the suite asks for: a reference on its way is
  /// not the truth yet.
  std::shared_ptr<const Reference> find(std::size_t reference);
  /// @throws base::InputError if there is none, or it lacks the part
  std::shared_ptr<const Reference> get(const ReferencePart& truth);

 private:
  const RunPlan& plan_;
  const ReferenceStore& store_;
  /// The one asked for last in front.
  std::list<std::pair<std::size_t, std::shared_ptr<const Reference>>> loaded_;
};

/// Whether the noise of a reference's part is known: the stored variance is that of all light.
bool has_variance(const Reference& reference, renderers::Part part);

/// The score of a reference against itself with noise of its own variance: errors below it are the
/// reference's. Nothing without a known noise, or where the score is not finite.
/// @param mask  pixels that take part; null: all
std::optional<double> noise_floor(const Reference& reference, renderers::Part part,
                                  const metrics::MetricChoice& choice,
                                  const perception::ViewingConditions& viewing,
                                  const perception::Image* mask = nullptr);

/// All light of a reference with noise of its own variance. One draw serves all channels of a
/// pixel: paths carry all of them, so their errors go up and down together.
perception::Image perturbed(const Reference& reference, std::uint64_t seed);

}  // namespace suites

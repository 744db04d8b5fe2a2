#include "results/figures/checkpoint_curves.h"

namespace results::figures {

// Runs keep the images of checkpoints, but no scores of them.
std::vector<CheckpointCurve> checkpoint_curves(const FigureRun& /*run*/, std::size_t /*row*/,
                                               const Quantity& /*score*/) {
  return {};
}

}  // namespace results::figures

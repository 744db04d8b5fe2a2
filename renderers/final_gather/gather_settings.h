#pragma once

#include <vector>

#include "perception/base/parameter_spec.h"
#include "renderers/element_hierarchy/radiosity_solver.h"
#include "renderers/final_gather/camera_samples.h"
#include "renderers/final_gather/link_gather.h"
#include "renderers/final_gather/sender_transfer.h"

namespace renderers::final_gather {

/// Parameters that all final gathers share, typed. Meanings: `gather_parameters`.
struct GatherSettings {
  element_hierarchy::SolverSettings solver;
  TransferSettings transfer;
  LinkGatherSettings gather;
  CameraSampleSettings camera;
  int environment_samples = 64;
};

std::vector<base::ParameterSpec> gather_parameters();
/// What preset `paper` sets of them.
std::vector<std::pair<std::string, base::ParameterValue>> paper_gather_values();
GatherSettings gather_settings_of(const base::Parameters& parameters);

}  // namespace renderers::final_gather

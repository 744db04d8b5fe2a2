#pragma once

#include "perception/base/document.h"
#include "suites/suite_file.h"

namespace suites {

/// Reads a scene's `reference: {renderer, samples, seed, own: {renderer, preset, parameters,
/// seed}}`.
/// @throws base::InputError with the place
ReferenceSpec read_reference(const base::Node& node);

/// What makes the reference of such claims: `own` and nothing else where its picture claims just
/// that, else the spec without it.
/// @param claims  part `all`
ReferenceSpec reference_spec_for(const ReferenceSpec& spec, const renderers::scene::Scene& scene,
                                 const renderers::Claims& claims);

}  // namespace suites

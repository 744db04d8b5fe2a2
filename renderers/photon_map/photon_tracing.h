#pragma once

#include <cstdint>
#include <vector>

#include "renderers/photon_map/photon.h"
#include "renderers/photon_map/photon_emission.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::photon_map {

struct PhotonTracingSettings {
  std::int64_t photons = 200000;  ///< emitted, >= 1
  ray_tracing::SequenceKind sequence = ray_tracing::SequenceKind::sobol;
  std::uint64_t seed = 1;
};

/// Photons of all bounces, in the order of their emission, with what became of their rays.
struct PhotonPaths {
  std::vector<Photon> photons;
  std::uint64_t rays = 0;
  std::uint64_t escaped = 0;  ///< paths that left the scene
};

/// Sends photons into the scene and stores them wherever they meet a surface with a Lambert lobe,
/// until Russian roulette absorbs them. The same photons with any number of threads.
///
/// Sources: Jensen 1996, Sec. 2.1; Arvo and Kirk 1990, "Particle Transport and Image Synthesis",
/// doi:10.1145/97879.97886 (roulette: a survivor's power is divided by its probability). With
/// shading normals a photon's power is scaled by |cos| to the shading normal over |cos| to the
/// triangle's, as light that arrives is measured by the one and photons land by the other: Veach
/// 1997, "Robust Monte Carlo Methods for Light Transport Simulation", Sec. 5.3. Light from below
/// the shading normal does not arrive, as in `ray_tracing::evaluate`; what is reflected leaves to
/// all of the triangle's side.
/// @throws base::InputError if more are stored than a tree can number
PhotonPaths trace_photons(const ray_tracing::RayScene& rays, const PhotonEmission& emission,
                          const PhotonTracingSettings& settings);

/// The photons of pieces one after another; each piece is freed once it is copied.
/// @param most_photons  >= 1, of all pieces together
/// @throws base::InputError if there are more
PhotonPaths joined(std::vector<PhotonPaths> pieces, std::uint64_t most_photons);

}  // namespace renderers::photon_map

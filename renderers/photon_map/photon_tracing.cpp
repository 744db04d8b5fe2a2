#include "renderers/photon_map/photon_tracing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "renderers/photon_map/photon_tree.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::photon_map {

namespace {

using ray_tracing::Hit;
using ray_tracing::SampleSequence;

/// Photons of one piece of work.
constexpr std::size_t kPiece = 1024;
/// At most this share survives a surface, so that a scene that absorbs nothing ends, too. Ours.
constexpr float kGreatestSurvival = 0.95F;

float largest(const glm::vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }

/// Follows one photon. @param photon  with its share of the power
void follow(const ray_tracing::RayScene& rays, EmittedPhoton photon, SampleSequence& numbers,
            PhotonPaths& paths) {
  for (;;) {
    ++paths.rays;
    Hit hit;
    if (!rays.intersect(photon.ray, hit)) {
      ++paths.escaped;
      return;
    }
    const glm::vec3& direction = photon.ray.direction;
    const float side = glm::dot(hit.geometric_normal, direction) < 0.0F ? 1.0F : -1.0F;
    const glm::vec3 normal = side * hit.geometric_normal;
    const glm::vec3 shading_normal = side * hit.shading_normal;
    const float cosine = -glm::dot(shading_normal, direction);
    const float geometric_cosine = -glm::dot(normal, direction);
    const glm::vec3 albedo = ray_tracing::diffuse_albedo(rays.scene(), hit);
    if (cosine <= 0.0F || geometric_cosine <= 0.0F || albedo == glm::vec3(0.0F)) return;
    photon.power *= cosine / geometric_cosine;
    paths.photons.push_back({hit.position, photon.power, direction, normal});

    const glm::vec4 u = numbers.next();
    const glm::vec3 reflected = photon.power * albedo;
    const float survival = std::min(kGreatestSurvival, largest(reflected) / largest(photon.power));
    if (u.z >= survival) return;
    photon.power = reflected / survival;
    const ray_tracing::Frame3 frame = ray_tracing::frame_around(normal);
    const glm::vec3 outgoing =
        glm::normalize(frame.to_world(ray_tracing::cosine_hemisphere({u.x, u.y})));
    // Below the shading normal, too: surfaces are seen from there, and reflect as much.
    photon.ray = ray_from(hit, outgoing);
  }
}

}  // namespace

PhotonPaths trace_photons(const ray_tracing::RayScene& rays, const PhotonEmission& emission,
                          const PhotonTracingSettings& settings) {
  const auto count = static_cast<std::size_t>(settings.photons);
  std::vector<PhotonPaths> pieces((count + kPiece - 1) / kPiece);
  base::parallel_for(count, kPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      SampleSequence numbers(settings.sequence, settings.seed, i);
      const glm::vec4 place = numbers.next();
      const glm::vec4 turn = numbers.next();
      auto photon = emission.emit(place, {turn.x, turn.y});
      if (!photon) continue;
      photon->power /= static_cast<float>(count);
      follow(rays, *photon, numbers, pieces[i / kPiece]);
    }
  });
  return joined(std::move(pieces), PhotonTree::kMostPhotons);
}

PhotonPaths joined(std::vector<PhotonPaths> pieces, std::uint64_t most_photons) {
  PhotonPaths all;
  std::uint64_t stored = 0;
  for (const PhotonPaths& piece : pieces) {
    stored += piece.photons.size();
    all.rays += piece.rays;
    all.escaped += piece.escaped;
  }
  if (stored > most_photons) {
    throw base::InputError(
        fmt::format("photon-map: photons are stored {} times; accepted: at most {}; lower the "
                    "parameter photons",
                    stored, most_photons));
  }
  all.photons.reserve(stored);
  for (PhotonPaths& piece : pieces) {
    const std::vector<Photon> photons = std::move(piece.photons);
    all.photons.insert(all.photons.end(), photons.begin(), photons.end());
  }
  return all;
}

}  // namespace renderers::photon_map

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "renderers/path_tracing/light_vertex.h"
#include "renderers/path_tracing/path_settings.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::path_tracing {

/// What one camera ray found.
struct PathSample {
  glm::vec3 direct{0.0F};    ///< radiance over paths that meet at most one surface
  glm::vec3 indirect{0.0F};  ///< radiance over all others
  glm::vec3 albedo{0.0F};    ///< diffuse + lobe reflectance of the first surface
  glm::vec3 normal{0.0F};    ///< its shading normal on the camera's side
  float depth_m = 0.0F;      ///< distance from the camera
  bool has_surface = false;  ///< false: the camera ray left the scene; the last three are 0
};

struct RayCounts {
  std::uint64_t camera = 0;
  std::uint64_t bounce = 0;
  std::uint64_t shadow = 0;
  std::uint64_t light = 0;
};

/// Estimates the rendering equation by paths: next-event estimation and reflected rays. Paths of
/// pixels beside each other go side by side, surface by surface, so that their rays are
/// packets; each has the numbers and sums that it would have alone.
///
/// With `light_rays` each path has a light vertex as well, to which all its surfaces are connected:
/// light that a lamp casts on what is near it, which reflected rays seldom meet, is found from the
/// lamp's side. The two ways to the same path are weighted by the power heuristic.
///
/// Sources: Kajiya 1986, "The Rendering Equation", doi:10.1145/15922.15902; Veach and Guibas 1995,
/// "Optimally Combining Sampling Techniques for Monte Carlo Rendering", doi:10.1145/218380.218498;
/// Arvo and Kirk 1990, "Particle Transport and Image Synthesis", doi:10.1145/97879.97886 (Russian
/// roulette); light vertices: see light_vertex.h.
class PathIntegrator {
 public:
  /// @param rays, lights  must live as long as this
  PathIntegrator(const ray_tracing::RayScene& rays, const ray_tracing::LightSampler& lights,
                 const PathSettings& settings);

  /// One path from each of some rays.
  /// @param camera_rays  that run beside each other; at most kPacketRays
  /// @param numbers      as many; each path draws from its own
  /// @param samples      as many, fresh: receive what the paths found
  void trace(std::span<const ray_tracing::Ray> camera_rays,
             std::span<ray_tracing::SampleSequence> numbers, std::span<PathSample> samples,
             RayCounts& counts) const;

 private:
  /// A path on its way. `surfaces` counts the reflections so far.
  struct State {
    ray_tracing::Ray ray;
    glm::vec3 throughput{1.0F};
    int surfaces = 0;
    float pdf = 0.0F;          ///< density of the ray's direction, 1/sr
    float last_cosine = 1.0F;  ///< at the surface it left
    std::optional<LightVertex> light_vertex;
  };

  /// What is sent to surfaces of the paths, one ray for each of them at most, if nothing stands
  /// between.
  struct Connections {
    std::array<ray_tracing::Ray, ray_tracing::kPacketRays> rays;
    std::array<glm::vec3, ray_tracing::kPacketRays> radiance;  ///< times the throughput
    std::array<glm::vec3*, ray_tracing::kPacketRays> sums;     ///< of a sample, to add it to
    std::size_t count = 0;

    void add(const ray_tracing::Ray& ray, const glm::vec3& light, glm::vec3& sum);
  };

  /// Rays to lights mostly run beside each other, those to light vertices do not.
  struct Senders {
    Connections lights;
    Connections light_vertices;
  };

  bool advance(State& path, const ray_tracing::Hit& hit, ray_tracing::SampleSequence& numbers,
               PathSample& sample, Senders& senders) const;
  void start(State& path, const ray_tracing::Ray& camera_ray, ray_tracing::SampleSequence& numbers,
             RayCounts& counts) const;
  void connect(Connections& connections, RayCounts& counts) const;
  std::uint32_t find_nearest(std::span<const ray_tracing::Ray> rays,
                             std::span<ray_tracing::LineHit> found) const;
  void add_emission(const State& path, const ray_tracing::Hit& hit, PathSample& sample) const;
  void add_environment(const State& path, PathSample& sample) const;
  void choose_light(const State& path, const ray_tracing::Hit& hit,
                    const ray_tracing::SurfaceBrdf& brdf, const glm::vec3& u, PathSample& sample,
                    Connections& connections) const;
  void choose_light_vertex(const State& path, const ray_tracing::SurfacePoint& point,
                           const ray_tracing::SurfaceBrdf& brdf, PathSample& sample,
                           Connections& connections) const;
  ray_tracing::SurfaceBrdf meet_surface(State& path, const ray_tracing::Hit& hit,
                                        PathSample& sample) const;
  bool reflect(State& path, const ray_tracing::SurfacePoint& point,
               const ray_tracing::SurfaceBrdf& brdf, ray_tracing::SampleSequence& numbers,
               float lobe_u) const;
  static glm::vec3& sum_of(const State& path, PathSample& sample);
  static void add(const State& path, const glm::vec3& radiance, PathSample& sample);
  bool is_wanted(int surfaces) const;
  float hit_weight(float hit_pdf, float light_pdf) const;
  float light_weight(const State& path, const ray_tracing::Hit& hit,
                     const ray_tracing::LightSample& light, float hit_pdf) const;
  ray_tracing::Lobes lobes_at(int surface) const;
  float clamp_factor(float cosine, float other_cosine, float distance2_m2) const;

  const ray_tracing::RayScene& rays_;
  const ray_tracing::LightSampler& lights_;
  PathSettings settings_;
  std::optional<LightVertexSampler> light_vertices_;  ///< none: not asked for, or no such light
  int surface_limit_;
  int reflection_limit_;  ///< reflected rays worth tracing
  float geometry_clamp_;  ///< 1/m2; 0: none
};

}  // namespace renderers::path_tracing

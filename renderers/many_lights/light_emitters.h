#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/opengl/view.h"
#include "renderers/scene/scene.h"

namespace renderers::many_lights {

/// How a point's or spot's samples are placed.
enum class LightSampling {
  map,  ///< evenly over the light's maps; cube faces in turn (the reflective shadow map's way)
  solid_angle  ///< evenly over the sphere or the cone
};

struct EmitterSettings {
  LightSampling sampling = LightSampling::solid_angle;
  int area_light_points = 16;       ///< points that stand for all emissive triangles together
  int environment_directions = 32;  ///< directions that stand for the environment
  int point_set = 0;                ///< another number gives other points and directions
};

/// Light of one sample of an emitter, as it arrives at what the map shows there.
struct EmittedSample {
  int view = 0;                  ///< of Emitter::views
  glm::dvec2 map_position{0.0};  ///< in [0, 1)^2, from the left and the top edge
  glm::dvec3 flux{0.0};          ///< W
};

enum class EmitterKind { point, spot, area, environment };

/// A source of light as maps see it.
struct Emitter {
  EmitterKind kind = EmitterKind::point;
  std::vector<opengl::View> views;
  /// rgb, W; of an environment: what meets the scene's bounding sphere; of area lights: textures
  /// taken by their means, whatever the point set.
  glm::dvec3 flux{0.0};

  /// Sample `index` of `count` of a pass, from Halton point index + 1 + pass count (bases 2, 3; 5
  /// for the point or direction). The fluxes of all samples sum to `flux` up to the error of
  /// numerical integration, which is that of the point sets where an area light is textured. With
  /// fewer samples than faces of a cube, only the mean over the passes does.
  std::function<EmittedSample(int index, int count, int pass)> sample;
};

/// Luminance of a colour (ITU-R BT.709-6, item 3.2).
double luminance(const glm::dvec3& color);

/// The emitters of a scene that have flux: its lights in order, then its emissive triangles
/// together, then its environment.
///
/// Flux of a sample, with n samples of the emitter [derived]:
///  - map with half-width tangent t, uniform: I(w) 4 t^2 cos^3(theta) / n, theta from the map's
///  axis
///    (t = 1 and n = the face's samples for a cube face). The solid angle of a piece of the map's
///    plane at distance 1 is its area times cos^3.
///  - uniform directions: I(w) solid angle / n;
///  - area light: K points, stratified by luminance x area of the emission (its texture's mean, so
///    pdf = mean L / sum of mean L A); cosine-distributed directions; each point sends
///    pi L(uv) / (K pdf), L(uv) the radiance at the point: pi L A / K without textures;
///  - environment: K directions drawn by luminance, parallel light over the disc around the scene,
///    L area / (K pdf), each.
/// Each of an area light's points takes all places of its stratum over the point sets, so that what
/// they light converges to the light of the whole area.
std::vector<Emitter> make_emitters(const scene::Scene& scene, const EmitterSettings& settings);

/// Whether points or directions of a point set stand for the emitter.
bool has_point_set(const Emitter& emitter);

/// Makes the emitters of another point set anew; the scene's lights stay, first in order.
/// @param emitters  of `make_emitters` with the same scene
void remake_point_sets(const scene::Scene& scene, const EmitterSettings& settings,
                       std::vector<Emitter>& emitters);

}  // namespace renderers::many_lights

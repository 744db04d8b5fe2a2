#include "renderers/scene/camera_reader.h"

#include "renderers/scene/value_reader.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <string>

namespace renderers::scene {
namespace {

float read_field_of_view(const base::Node& node) {
  const float fov_deg = read_float(node, "vertical_fov_deg");
  if (fov_deg > 0.0F && fov_deg < 180.0F) return fov_deg;
  throw base::InputError(node.place(),
                         fmt::format("vertical_fov_deg {} is outside (0, 180)", fov_deg));
}

/// @param when  ends the message
void check_view(const glm::vec3& forward, const glm::vec3& up, const base::Place& place,
                const std::string& when) {
  const float distance_m = glm::length(forward);
  if (distance_m == 0.0F) {
    throw base::InputError(place, "look_at is the camera's position" + when);
  }
  // Below about 0.06 degrees the picture's horizon is rounding noise.
  constexpr float kMinSine = 1e-3F;
  if (glm::length(glm::cross(forward / distance_m, up)) < kMinSine) {
    throw base::InputError(place, "the camera looks along its up direction" + when + "; change up");
  }
}

/// The view direction goes along a straight line from key to key; its part across `up` is
/// shortest at one point of it, or at the keys.
void check_way(const Key<Camera>& a, const Key<Camera>& b, const base::Place& place) {
  const glm::vec3 from = a.value.look_at - a.value.position;
  const glm::vec3 step = (b.value.look_at - b.value.position) - from;
  const glm::vec3 across_from = glm::cross(from, a.value.up);
  const glm::vec3 across_step = glm::cross(step, a.value.up);
  const float speed2 = glm::dot(across_step, across_step);
  if (speed2 == 0.0F) return;
  const float t = glm::clamp(-glm::dot(across_from, across_step) / speed2, 0.0F, 1.0F);
  check_view(from + t * step, a.value.up, place,
             fmt::format(" between frames {} and {}", a.frame, b.frame));
}

Camera read_camera_key(base::MapReader& key, const Camera& rest) {
  Camera camera = rest;
  if (const auto* node = key.find("position")) camera.position = read_vec3(*node, "position");
  const base::Node* look_at = key.find("look_at");
  if (look_at != nullptr) camera.look_at = read_vec3(*look_at, "look_at");
  if (const auto* node = key.find("vertical_fov_deg")) {
    camera.vertical_fov_deg = read_field_of_view(*node);
  }
  const base::Node& shown = look_at == nullptr ? key.node() : *look_at;
  check_view(camera.look_at - camera.position, camera.up, shown.place(), "");
  return camera;
}

}  // namespace

Track<Camera> read_camera(const SourceNode& source, const base::Place& file) {
  if (source.node == nullptr) {
    throw base::InputError(
        file, "scene has no camera; add camera: {position, look_at, vertical_fov_deg}");
  }
  base::MapReader reader(*source.node, "camera");
  Camera camera;
  camera.position = read_vec3(reader.require("position"), "position");
  const base::Node& look_at = reader.require("look_at");
  camera.look_at = read_vec3(look_at, "look_at");
  if (const auto* node = reader.find("up")) camera.up = read_direction(*node, "up");
  camera.vertical_fov_deg = read_field_of_view(reader.require("vertical_fov_deg"));
  check_view(camera.look_at - camera.position, camera.up, look_at.place(), "");
  const Track<Camera> track = read_track(reader, camera, read_camera_key);
  reader.finish();
  for (std::size_t i = 1; i < track.keys.size(); ++i) {
    check_way(track.keys[i - 1], track.keys[i], source.node->place());
  }
  return track;
}

Camera mix_cameras(const Camera& a, const Camera& b, float t) {
  Camera camera = a;
  camera.position = glm::mix(a.position, b.position, t);
  camera.look_at = glm::mix(a.look_at, b.look_at, t);
  camera.vertical_fov_deg = glm::mix(a.vertical_fov_deg, b.vertical_fov_deg, t);
  return camera;
}

}  // namespace renderers::scene

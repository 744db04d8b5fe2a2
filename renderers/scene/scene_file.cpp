#include "renderers/scene/scene_file.h"

#include "perception/base/names.h"
#include "renderers/scene/camera_reader.h"
#include "renderers/scene/light_reader.h"
#include "renderers/scene/material_reader.h"
#include "renderers/scene/object_reader.h"
#include "renderers/scene/scene_hash.h"
#include "renderers/scene/scene_layers.h"
#include "renderers/scene/scene_overlay.h"
#include "renderers/scene/value_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace renderers::scene {

/// What all frames share, and how the objects move.
struct SceneFile::Content {
  std::string summary;
  Scene shared;  ///< without objects, lights and camera; materials without animation
  Track<Camera> camera;
  std::vector<Track<Light>> lights;
  std::vector<MaterialTrack> materials;  ///< those that are animated
  std::vector<MovingObject> objects;
  std::vector<std::string> warnings;
};

namespace {

std::string read_name(const SceneLayers& layers, const base::Place& file) {
  if (layers.scene.node == nullptr) {
    throw base::InputError(file, "scene has no name; add scene: <name>");
  }
  const std::string& name = layers.scene.node->text("scene");
  if (!base::is_path_safe(name)) {
    throw base::InputError(
        layers.scene.node->place(),
        fmt::format("scene \"{}\" is no usable name; accepted: letters, digits, -, _ and .", name));
  }
  return base::kebab_case(name);
}

std::string read_summary(const SceneLayers& layers) {
  if (layers.summary.node == nullptr) return "";
  const std::string& summary = layers.summary.node->text("summary");
  if (summary.find('\n') == std::string::npos) return summary;
  throw base::InputError(layers.summary.node->place(), "summary must be one line");
}

bool is_animated(const SceneFile::Content& content) {
  return content.camera.is_animated || !content.materials.empty() ||
         std::ranges::any_of(content.lights, &Track<Light>::is_animated) ||
         std::ranges::any_of(content.objects, &MovingObject::is_animated);
}

std::unique_ptr<SceneFile::Content> read_content(const SceneLayers& layers,
                                                 const base::Place& file) {
  auto content = std::make_unique<SceneFile::Content>();
  Scene& scene = content->shared;
  scene.name = read_name(layers, file);
  content->summary = read_summary(layers);
  if (const base::Node* scale = layers.luminance_scale.node) {
    scene.luminance_scale_cd_m2 = read_positive(*scale, "luminance_scale_cd_m2");
  }
  content->camera = read_camera(layers.camera, file);
  scene.environment = read_environment(layers.environment);
  for (const NamedSource& light : layers.lights) content->lights.push_back(read_light(light));

  MaterialTable table = read_materials(layers.materials);
  ObjectReader objects(table, content->warnings);
  for (const NamedSource& object : layers.objects) objects.read(object);
  content->objects = objects.take_objects();
  if (content->objects.empty()) throw base::InputError(file, "scene has no objects");
  scene.materials = std::move(table.materials);
  scene.textures = std::move(table.textures);
  content->materials = std::move(table.tracks);
  scene.is_animated = is_animated(*content);
  return content;
}

}  // namespace

SceneFile::SceneFile() = default;
SceneFile::~SceneFile() = default;
SceneFile::SceneFile(SceneFile&&) noexcept = default;
SceneFile& SceneFile::operator=(SceneFile&&) noexcept = default;

const std::string& SceneFile::name() const { return content_->shared.name; }
const std::string& SceneFile::summary() const { return content_->summary; }
std::vector<std::string> SceneFile::warnings() const { return content_->warnings; }

int SceneFile::frame_count() const {
  int last = content_->camera.last_frame();
  for (const auto& light : content_->lights) last = std::max(last, light.last_frame());
  for (const auto& track : content_->materials) last = std::max(last, track.colors.last_frame());
  for (const auto& object : content_->objects) last = std::max(last, object.last_frame());
  return last + 1;
}

Scene SceneFile::at_frame(int frame) const {
  if (frame < 0)
    throw base::InputError(fmt::format("frame {} is negative; frames start at 0", frame));
  Scene scene = content_->shared;
  scene.frame_index = frame;
  scene.camera = content_->camera.at(frame, mix_cameras);
  for (const auto& light : content_->lights) scene.lights.push_back(light.at(frame, mix_lights));
  for (const MaterialTrack& track : content_->materials) {
    const MaterialColors colors = track.colors.at(frame, mix_colors);
    scene.materials[track.material].albedo = colors.albedo;
    scene.materials[track.material].emission = colors.emission;
  }
  std::vector<base::Hash> mesh_hashes;
  for (const MovingObject& object : content_->objects) {
    const glm::mat4 to_world = matrix_of(object.pose.at(frame, mix_poses));
    const HashedMesh mesh = object.mesh_at(frame);
    scene.objects.push_back({object.name, mesh.mesh, object.material, to_world});
    mesh_hashes.push_back(mesh.hash);
  }
  if (const Object* object = find_non_finite(scene)) {
    throw base::InputError(fmt::format(
        "object \"{}\" has vertices at frame {} that are NaN or infinite; its transform, deform or "
        "shape leaves the range of numbers",
        object->name, frame));
  }
  scene.hash = content_hash(scene, mesh_hashes);
  scene.world_hash = world_hash(scene, mesh_hashes);
  return scene;
}

SceneFile read_scene_file(const std::filesystem::path& path, std::span<const base::Node> overlays) {
  return parse_scene(base::read_document(path), path.parent_path(), overlays);
}

SceneFile parse_scene(const base::Node& node, const std::filesystem::path& folder,
                      std::span<const base::Node> overlays) {
  SceneLayers layers = merge_layers(node, folder);
  for (const base::Node& overlay : overlays) lay_over(layers, overlay, folder);
  SceneFile file;
  file.content_ = read_content(layers, node.place());
  return file;
}

}  // namespace renderers::scene

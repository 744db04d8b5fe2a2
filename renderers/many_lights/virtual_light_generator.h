#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/contract/stage_timer.h"
#include "renderers/many_lights/light_assignment.h"
#include "renderers/many_lights/light_emitters.h"
#include "renderers/many_lights/virtual_light.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/geometry_buffer.h"
#include "renderers/opengl/gpu_scene.h"

namespace renderers::many_lights {

struct GeneratorSettings {
  int light_count = 1024;  ///< N
  EmitterSettings emitters{};
  int map_size_px = 512;       ///< of point and spot lights, per face
  int area_map_size_px = 128;  ///< of area lights, per face of each point
  int environment_map_size_px = 256;
  std::int64_t kept_map_bytes = std::int64_t{256} << 20;  ///< maps beyond it are drawn every pass
};

/// What a pass made.
struct LightTotals {
  int valid = 0;         ///< lights that have flux
  glm::dvec3 flux{0.0};  ///< their sum, rgb, W
  bool is_dark() const { return luminance(flux) <= 0.0; }
};

/// Makes N virtual lights from reflective shadow maps of the scene's emitters (Dachsbacher and
/// Stamminger 2005, doi:10.1145/1053427.1053460). The emitters' fluxes
/// alone decide which emitter light i belongs to and which of its samples it is: in a scene whose
/// fluxes stay as they are, light i of a pass is of the same emitter and Halton point in every
/// state. Where fluxes change, or a point set changes an environment's flux, lights are dealt anew
/// and light i may go to another emitter or sample.
class VirtualLightGenerator {
 public:
  VirtualLightGenerator(std::shared_ptr<opengl::Context> context,
                        const GeneratorSettings& settings);

  /// A new state of the scene: makes its emitters with point set 0, forgets the maps.
  void load(const scene::Scene& scene);
  /// Lets other points and directions stand for area lights and environment and forgets their maps;
  /// those of point and spot lights stay.
  /// @param scene      of the state given to `load`
  /// @param point_set  >= 0
  void use_point_set(const scene::Scene& scene, int point_set);
  /// Whether points or directions stand for any of the emitters.
  bool has_point_sets() const;

  /// Draws the maps it lacks and fetches the lights of a pass. Stages `lights/map` and
  /// `lights/sample`.
  /// @param scene  of the state given to `load`
  /// @param pass   >= 0; passes continue the emitters' Halton sequences
  void generate(const opengl::GpuScene& scene, int pass, StageTimer& timer);

  /// N VirtualLight.
  const opengl::Buffer& lights() const { return lights_; }
  int light_count() const { return settings_.light_count; }
  const std::vector<Emitter>& emitters() const { return emitters_; }
  /// Emitters that got no light because there are more of them than lights.
  int emitters_left_out() const { return emitters_left_out_; }
  /// Maps drawn by the last `generate`.
  int maps_drawn() const { return maps_drawn_; }
  /// Reads the lights back. A sum of zero is a scene whose light meets nothing.
  LightTotals read_totals() const;
  std::int64_t memory_bytes() const;

 private:
  struct Map {
    std::unique_ptr<opengl::GeometryBuffer> kept;  ///< null: drawn into `spare_` every time
    bool is_current = false;
  };
  struct ViewSamples;

  int size_px_of(const Emitter& emitter) const;
  void deal_lights();
  /// Matches maps to the emitters' views and forgets what they show from a view on.
  void forget_maps(std::size_t first_view);
  std::vector<ViewSamples> draw_samples(int pass) const;
  /// Frees the maps that show nothing any more and are not about to be drawn.
  void free_maps_but(std::span<const ViewSamples> views);
  /// The maps of the first views, of as many as can stand beside each other; at least one.
  std::vector<const opengl::GeometryBuffer*> draw_maps(std::span<const ViewSamples> views,
                                                       const opengl::GpuScene& scene,
                                                       StageTimer& timer);
  opengl::GeometryBuffer& map_buffer(std::size_t view, int size_px);
  void fetch(const opengl::GeometryBuffer& map, const ViewSamples& view, int first_sample);

  std::shared_ptr<opengl::Context> context_;
  GeneratorSettings settings_;
  std::vector<Emitter> emitters_;
  std::vector<LightSlot> slots_;
  std::vector<int> counts_;              ///< lights by emitter
  std::vector<std::size_t> first_view_;  ///< index of each emitter's first view among all
  std::vector<Map> maps_;                ///< by view
  std::map<int, std::unique_ptr<opengl::GeometryBuffer>> spare_;  ///< by size
  std::int64_t kept_bytes_ = 0;
  opengl::Buffer lights_;
  opengl::Buffer samples_;
  int emitters_left_out_ = 0;
  int maps_drawn_ = 0;
};

}  // namespace renderers::many_lights

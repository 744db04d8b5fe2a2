#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "perception/base/parameter_spec.h"
#include "perception/image.h"
#include "perception/image_file.h"
#include "renderers/contract/devices.h"
#include "renderers/contract/stage_timer.h"
#include "renderers/contract/transport.h"
#include "renderers/scene/scene.h"

namespace renderers {

/// Receives the image so far of a progressive renderer; its time is not the renderer's. Called
/// after the stage `readback` that made the image has closed.
/// @param radiance  the estimate; valid during the call only
/// @param samples   progressive units done
using CheckpointSink = std::function<void(const perception::Image& radiance, std::int64_t samples)>;

/// One image to make.
struct RenderJob {
  int width_px = 0;
  int height_px = 0;
  scene::Camera camera;
  std::uint64_t seed = 1;
  int frame_index = 0;
  std::optional<std::int64_t> samples;  ///< progressive units; the parameter's value if absent
  std::optional<double> time_budget_s;  ///< stop starting new work when it is used up
  CheckpointSink checkpoint;            ///< may be empty
};

/// A counter's value: one number, or a series over iterations or frames.
using CounterValue = std::variant<double, std::vector<double>>;

/// What a renderer returns.
struct Frame {
  perception::Image radiance;                ///< R, G, B, scene_linear
  std::vector<perception::NamedImage> aovs;  ///< same size: "albedo", "normal", "variance", ...
  std::vector<std::pair<std::string, CounterValue>> counters;
  std::vector<std::string> notes;
  std::int64_t samples = 0;    ///< progressive units done; 0 for a renderer without one
  std::string device = "cpu";  ///< or GL_RENDERER
  std::string gl_platform;     ///< egl-device | egl-surfaceless | osmesa; empty: none
};

/// One technique with resolved parameters. Not thread-safe; used by one thread at a time.
///
/// Determinism: without a time budget a frame depends on (scene, job) alone, whatever the number of
/// threads; with `RendererInfo::history` on the frames before it, too.
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// Cold start: everything the scene needs, at its first frame.
  /// @throws base::InputError for what it refuses, DeviceError, UnsupportedError, std::bad_alloc
  virtual void prepare(const scene::Scene& scene, StageTimer& timer) = 0;
  /// Next frame of a sequence: geometry, materials and lights may all have changed.
  virtual void update(const scene::Scene& scene, StageTimer& timer) { prepare(scene, timer); }
  /// Callable again with another camera. The scene of the last prepare or update must live.
  virtual Frame render(const RenderJob& job, StageTimer& timer) = 0;
};

/// What a scene may hold; see `scene::features_of`.
using scene::Feature;

/// A renderer's entry in the explicit table of renderer_list.h.
struct RendererInfo {
  std::string name;     ///< kebab-case
  std::string summary;  ///< one sentence
  std::string source;   ///< citation
  /// What the method's image of this scene is an estimate of; bounds relative to the scene's size
  /// are resolved here.
  Claims (*claims)(const base::Parameters& parameters, const scene::Scene& scene) = nullptr;
  std::vector<Claims> possible_claims;  ///< for `list renderers`; clamps left out
  std::vector<Feature> supports;
  std::optional<std::string> progressive_unit;  ///< "samples per pixel"; none: runs once
  bool uses_seed = false;
  int version = 1;       ///< raised when the same parameters give other pixels
  bool history = false;  ///< frame n depends on the frames before it
  std::vector<base::ParameterSpec> parameters;
  std::vector<base::Preset> presets;  ///< always "paper" and "best"
  /// May throw UnsupportedError if the device lacks what the parameters need.
  std::function<std::unique_ptr<Renderer>(const base::Parameters&, const Devices&)> create;
};

}  // namespace renderers

#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "perception/base/units.h"
#include "renderers/renderer_list.h"
#include "results/run_record.h"

namespace suites {

/// One renderer with resolved parameters, as a suite's method or the `render` verb names it.
struct MethodChoice {
  const renderers::RendererInfo* info = nullptr;
  std::string preset;  ///< "best" unless named
  base::Parameters parameters;
};

/// What is rendered and timed once: one repetition, or one frame of a sequence's repetition.
struct MeasureRequest {
  const renderers::scene::Scene* scene = nullptr;
  MethodChoice method;
  base::SizePx size_px;
  std::uint64_t seed = 1;
  int frame = 0;
  std::optional<std::int64_t> samples;
  std::optional<double> time_budget_s;
  renderers::Devices devices;
  std::filesystem::path checkpoint_folder;  ///< empty: no checkpoints are kept
  bool has_new_view = false;                ///< measure new_view_s, too
  bool is_last = true;                      ///< no `measure_next` follows on this one
};

struct Measurement {
  results::RenderRecord record;  ///< everything but `image`
  renderers::Frame frame;        ///< empty images unless record.status is ok or non_finite
  /// Images are file names in checkpoint_folder; elapsed_s is what total_s was at that image.
  std::vector<results::Checkpoint> checkpoints;
  std::optional<std::string> storage_error;  ///< a checkpoint could not be written, and why
  /// The request is to blame: the renderer refuses a parameter or the scene (status `unsupported`),
  /// or the picture cannot fit in memory (`out_of_memory`).
  bool is_refused = false;
};

/// What is rendered before anything is timed.
struct WarmUp {
  int renders = 1;           ///< of about 64x64; what they throw is left to `measure` to report
  bool is_sequence = false;  ///< each updates and renders once more
  /// Of the pictures to come: a side that is a power of two is warmed up with another one, as Mesa
  /// compiles its shaders once for each.
  base::SizePx size_px{64, 64};
};

/// Of the pictures that warm up for pictures of a size: 64 or, where a side is no power of two, 56.
base::SizePx warm_up_size(const base::SizePx& pictures_px);

/// A renderer kept warm for repetitions (DESIGN section 3, clock): construction and one render at
/// 64x64 are `start_up_s`, never part of `total_s`. Graphics contexts and compiled shaders are
/// shared by all renderers that it makes; nothing of a scene is.
class MeasuredRenderer {
 public:
  MeasuredRenderer(const MethodChoice& method, const renderers::scene::Scene& scene,
                   const renderers::Devices& devices, const WarmUp& warm_up = {});
  ~MeasuredRenderer();

  double start_up_s() const { return start_up_s_; }

  /// prepare + render of a cold renderer of the same method, timed. `render_s` leaves checkpoints
  /// out; prepare_s + render_s - readback_s = total_s. Never throws for what the renderer does: a
  /// scene feature it lacks, an UnsupportedError and an InputError give `unsupported`, another
  /// exception `crash` or `out_of_memory`, a NaN `non_finite`, with the reason. A picture that
  /// cannot fit in memory is not begun: `out_of_memory`.
  ///
  /// With `has_new_view`, render is called once more with `turned_camera`: new_view_s.
  /// @param request  its scene must live until the next call, unless `is_last`
  Measurement measure(const MeasureRequest& request);

  /// update + render of the renderer that made the frame before:
  /// update_s + render_s - readback_s = next_frame_s. After a failure there is no such renderer.
  Measurement measure_next(const MeasureRequest& request);
  bool has_next() const { return renderer_ != nullptr; }

 private:
  void render_cold(const MeasureRequest& request, Measurement& measurement);
  void render_next(const MeasureRequest& request, Measurement& measurement);
  Measurement measured(const MeasureRequest& request,
                       const std::function<void(Measurement&)>& render);

  MethodChoice method_;
  renderers::Devices devices_;
  double start_up_s_ = 0.0;
  std::string warm_up_failure_;                    ///< "" if it went well
  std::size_t channels_;                           ///< of the images of a frame, as far as known
  std::unique_ptr<renderers::Renderer> renderer_;  ///< of a sequence that goes on
};

/// The fields of a record that are known before anything has run: scene, renderer, parameters in
/// force, what they claim, size, seed, threads.
results::RenderRecord described(const MeasureRequest& request);

/// Warm-up and one repetition: what the `render` verb does.
Measurement measure_once(const MeasureRequest& request);

/// The radiance first, then the AOVs, with provenance attributes of the record (scene, renderer,
/// parameters, samples, seed, seconds, luminance scale).
perception::ImageFile image_file_of(const Measurement& measurement, double luminance_scale_cd_m2);

}  // namespace suites

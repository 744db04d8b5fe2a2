#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/names.h"
#include "perception/display_model.h"
#include "perception/image_file.h"
#include "renderers/scene/scene_file.h"
#include "suites/command_line/ad_hoc_suite.h"
#include "suites/command_line/exit_codes.h"
#include "suites/command_line/interrupt.h"
#include "suites/command_line/rectangle.h"
#include "suites/command_line/render_output.h"
#include "suites/command_line/verbs.h"
#include "suites/measurement.h"

namespace suites::command_line {

namespace {

bool is_png(const std::filesystem::path& path) {
  return base::is_same_name(path.extension().string(), ".png");
}

/// Everything that can be wrong about the output, before any time is spent on rendering.
void check_output(const RenderArguments& arguments) {
  const std::filesystem::path path = arguments.out;
  if (!is_png(path) && !base::is_same_name(path.extension().string(), ".exr")) {
    throw base::InputError({"--out"}, fmt::format("\"{}\" has extension \"{}\"; accepted: .exr, "
                                                  ".png",
                                                  arguments.out, path.extension().string()));
  }
  if (arguments.exposure_ev && !is_png(path)) {
    throw base::InputError({"--exposure"},
                           "EXR keeps scene-linear values; accepted with a .png output only");
  }
  if (std::filesystem::is_directory(path)) {
    throw base::InputError({"--out"},
                           fmt::format("\"{}\" is a folder; accepted: a file name", arguments.out));
  }
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!std::filesystem::is_directory(folder)) {
    throw base::InputError({"--out"}, fmt::format("folder \"{}\" does not exist", folder.string()));
  }
}

/// While it lives, what anybody prints on stdout goes to stderr: stdout is for our data alone.
class QuietStdout {
 public:
  QuietStdout() : stdout_fd_(dup(STDOUT_FILENO)) {
    std::fflush(stdout);
    answer_interrupts_on(stdout_fd_);
    dup2(STDERR_FILENO, STDOUT_FILENO);
  }
  ~QuietStdout() {
    std::fflush(stdout);
    dup2(stdout_fd_, STDOUT_FILENO);
    answer_interrupts_on(STDOUT_FILENO);
    close(stdout_fd_);
  }
  QuietStdout(const QuietStdout&) = delete;
  QuietStdout& operator=(const QuietStdout&) = delete;

 private:
  int stdout_fd_;
};

Measurement measure_quietly(const MeasureRequest& request) {
  const QuietStdout quiet;
  return measure_once(request);
}

/// Renderer, preset and parameters; `--set samples=N` means `--samples N`.
MethodChoice method_of(const RenderArguments& arguments, std::optional<std::int64_t>& samples) {
  MethodChoice choice;
  choice.info = &renderers::find_renderer(arguments.renderer, {"--renderer"});
  const base::Preset& preset = renderers::find_preset(*choice.info, arguments.preset, {"--preset"});
  choice.preset = preset.name;
  std::vector<base::ParameterSetting> settings;
  for (const std::string& text : arguments.settings) {
    settings.push_back(base::parse_setting(text, "--set"));
  }
  choice.parameters = base::resolve_parameters(choice.info->parameters, &preset, settings,
                                               fmt::format("renderer \"{}\"", choice.info->name));
  const bool is_declared = choice.parameters.contains("samples");
  const bool is_set = std::any_of(settings.begin(), settings.end(),
                                  [](const auto& s) { return s.name == "samples"; });
  if (is_declared && is_set) {
    const std::int64_t value = choice.parameters.integer("samples");
    if (samples && *samples != value) {
      throw base::InputError(
          fmt::format("--samples {} and --set samples={} disagree; give one", *samples, value));
    }
    samples = value;
  }
  if (is_declared && samples) choice.parameters.set("samples", *samples);
  return choice;
}

/// A renderer without a progressive unit has nothing to count or to stop.
void check_budget(const MethodChoice& choice, const MeasureRequest& request) {
  if (choice.info->progressive_unit || (!request.samples && !request.time_budget_s)) return;
  throw base::InputError(
      {request.samples ? "--samples" : "--time"},
      fmt::format("renderer \"{}\" has no progressive unit and runs once; leave it out",
                  choice.info->name));
}

MeasureRequest request_of(const RenderArguments& arguments) {
  MeasureRequest request;
  request.samples = arguments.samples;
  request.method = method_of(arguments, request.samples);
  request.size_px = base::parse_size_px(arguments.size, {"--size"});
  request.seed = arguments.seed;
  request.frame = arguments.frame;
  if (!arguments.time.empty()) {
    if (request.samples) {
      throw base::InputError({"--time"}, "cannot be given together with a number of samples");
    }
    request.time_budget_s = base::parse_duration_s(arguments.time, {"--time"});
  }
  request.devices.threads = arguments.threads;
  request.devices.platform = arguments.device;
  check_budget(request.method, request);
  return request;
}

}  // namespace

int run_render(const RenderArguments& arguments, Console& console) {
  check_output(arguments);
  MeasureRequest request = request_of(arguments);
  RenderOutputOptions output{arguments.out, is_png(arguments.out), arguments.aov, {}, 0.0};
  if (!arguments.crop.empty()) {
    output.crop = parse_rectangle(arguments.crop, request.size_px, {"--crop"});
  }
  output.exposure_ev = arguments.exposure_ev.value_or(0.0);
  const auto file = renderers::scene::read_scene_file(find_scene_option(arguments.scene));
  const renderers::scene::Scene scene = file.at_frame(arguments.frame);
  request.scene = &scene;

  Measurement measurement = measure_quietly(request);
  if (measurement.is_refused) {
    const bool is_too_large = measurement.record.status == results::Status::out_of_memory;
    const std::string reason = measurement.record.reason.value_or("");
    throw is_too_large ? base::InputError({"--size"}, reason) : base::InputError(reason);
  }
  for (const std::string& warning : file.warnings()) measurement.record.notes.push_back(warning);
  if (!measurement.frame.radiance.is_empty()) {
    write_render_output(measurement, scene.luminance_scale_cd_m2, output);
    measurement.record.image = arguments.out;
  }
  if (arguments.json) {
    print_json(console, render_json(measurement.record, output));
  } else {
    console.out << render_text(measurement.record);
    for (const std::string& note : measurement.record.notes) print_note(console, note);
  }
  if (results::is_success(measurement.record.status)) return kAsExpected;
  if (!arguments.json) {
    print_error(console, fmt::format("{}: {}", results::to_string(measurement.record.status),
                                     measurement.record.reason.value_or("no reason known")));
  }
  return kCellsFailed;
}

}  // namespace suites::command_line

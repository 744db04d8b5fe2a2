#include "suites/command_line/render_output.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/errors.h"
#include "perception/base/names.h"
#include "perception/base/units.h"
#include "perception/display_model.h"
#include "suites/command_line/console.h"

namespace suites::command_line {

namespace {

/// Leaves one part of a file: an AOV by name.
void keep_part(perception::ImageFile& file, const std::string& name) {
  std::vector<std::string> known;
  for (const perception::NamedImage& part : file.parts) known.push_back(part.name);
  const auto found = std::find_if(file.parts.begin(), file.parts.end(), [&name](const auto& part) {
    return base::is_same_name(part.name, name);
  });
  if (found == file.parts.end()) {
    throw base::InputError({"--aov"}, base::unknown_name("AOV of this renderer", name, known));
  }
  perception::NamedImage kept = std::move(*found);
  file.parts.clear();
  file.parts.push_back(std::move(kept));
}

}  // namespace

void write_render_output(const Measurement& measurement, double luminance_scale_cd_m2,
                         const RenderOutputOptions& options) {
  perception::ImageFile file = image_file_of(measurement, luminance_scale_cd_m2);
  if (!options.aov.empty()) keep_part(file, options.aov);
  if (options.crop) {
    const RectanglePx& r = *options.crop;
    for (perception::NamedImage& part : file.parts) {
      part.image = perception::crop(part.image, r.x, r.y, r.width, r.height);
    }
  }
  if (!options.is_png) {
    perception::write_exr(options.path, file);
    return;
  }
  const perception::Image rgb = perception::rgb_of(file.parts.front().image);
  perception::write_png(options.path, perception::to_display_encoded(rgb, options.exposure_ev));
}

nlohmann::ordered_json render_json(const results::RenderRecord& record,
                                   const RenderOutputOptions& options) {
  nlohmann::ordered_json json = results::to_json(record);
  json["aov"] =
      options.aov.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(options.aov);
  json["crop_px"] = nullptr;
  if (options.crop) {
    json["crop_px"] = {options.crop->x, options.crop->y, options.crop->width, options.crop->height};
  }
  return json;
}

std::string render_text(const results::RenderRecord& record) {
  const auto duration = [](double seconds) { return base::format_duration(seconds); };
  std::string text = fmt::format("{}  {} ({})  {} {}  {}x{}  {}seed {}  {}, {} threads\n",
                                 record.scene, record.renderer, record.preset, record.transport,
                                 record.part, record.width_px, record.height_px,
                                 record.samples ? fmt::format("{} samples  ", *record.samples) : "",
                                 record.seed, record.device, record.threads);
  text +=
      fmt::format("total {} (prepare {}, render {}); start-up {}, readback {}, peak {}\n",
                  duration(record.total_s), duration(record.prepare_s), duration(record.render_s),
                  duration(record.start_up_s), duration(record.readback_s),
                  base::format_bytes(static_cast<double>(record.peak_memory_bytes)));
  std::vector<std::vector<std::string>> rows{{"phase", "stage", "wall", "cpu", "calls"}};
  for (const renderers::StageRecord& stage : record.stages) {
    rows.push_back({renderers::to_string(stage.phase), stage.path, duration(stage.wall_s),
                    duration(stage.cpu_s), std::to_string(stage.calls)});
  }
  rows.push_back({"", "unattributed", duration(record.unattributed_s), "", ""});
  text += text_table(rows);
  if (!record.image.empty()) text += "image " + record.image + "\n";
  return text;
}

}  // namespace suites::command_line

#include "tests/results/viewer_run.h"

#include <functional>
#include <limits>

#include <nlohmann/json.hpp>

#include "perception/image_file.h"
#include "perception/viewing_conditions.h"
#include "tests/results/synthetic_run.h"

namespace test_results {

namespace fs = std::filesystem;
using perception::Image;

namespace {

Image image_of(int width_px, int height_px, const std::function<float(int x)>& value) {
  Image image = perception::make_rgb_image(width_px, height_px, perception::Encoding::scene_linear);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = value(x);
    }
  }
  return image;
}

Image ramp() {
  return image_of(16, 12, [](int x) { return 0.25F + static_cast<float>(x) / 64.0F; });
}

Image flat(int width_px, int height_px, float value) {
  return image_of(width_px, height_px, [value](int) { return value; });
}

void write(const fs::path& path, const Image& image) {
  fs::create_directories(path.parent_path());
  perception::write_exr(path, {{{"", image}}, {}});
}

results::CellRecord add(results::RunFolder& run, const std::string& scene,
                        const std::string& method, const Image& image, int frame = 0) {
  results::CellRecord cell = timed_cell(scene, method, 1, 1.0);
  cell.cell = scene + "." + (method == "ramp" ? "ramp" : "flat");
  cell.render.frame = frame;
  if (frame > 5) {
    cell.render.total_s = std::numeric_limits<double>::quiet_NaN();
    cell.render.next_frame_s = 0.1;
  }
  cell.render.image = "images/" + cell.cell + "/frame-" + std::to_string(frame) + ".exr";
  write(run.path() / cell.render.image, image);
  run.append(cell);
  return cell;
}

/// A relmse score with a map of one value.
void add_score(results::RunFolder& run, const results::CellRecord& cell, float of_map) {
  results::MetricRecord score = full_metric_record();
  score.cell = cell.cell;
  score.frame = cell.render.frame;
  score.reference_hash = "aaaa";
  score.metric = "relmse";
  score.map = "maps/" + cell.cell + "." + std::to_string(cell.render.frame) + ".exr";
  Image map = perception::make_gray_image(16, 12, "Y", perception::Encoding::scene_linear);
  for (float& value : map.pixels) value = of_map;
  write(run.path() / score.map, map);
  run.append(score);
}

}  // namespace

fs::path write_viewer_run(const fs::path& root) {
  results::RunFolder run =
      results::RunFolder::open_for_writing(root / "runs/viewer/20261122T001209Z-0a1b2c");
  write(root / "references/aaaa/reference.exr", flat(16, 12, 0.25F));
  add_score(run, add(run, "box", "ramp", ramp()), 0.01F);
  Image with_nan = flat(16, 12, 0.5F);
  with_nan.at(3, 2, 1) = std::numeric_limits<float>::quiet_NaN();
  add(run, "box", "<b>flat", with_nan);
  for (const int frame : {5, 6, 7}) {
    const float value = static_cast<float>(1 << (frame - 5)) / 8.0F;
    const results::CellRecord cell = add(run, "moving", "ramp", flat(16, 12, value), frame);
    if (frame < 7) add_score(run, cell, value / 10.0F);
  }
  add(run, "sizes", "ramp", ramp());
  add(run, "sizes", "<b>flat", flat(8, 6, 0.5F));
  nlohmann::ordered_json info{{"schema", 1}, {"suite", "viewer"}};
  info["viewing"] = perception::to_json(perception::default_viewing_conditions());
  info["scenes"] = {{{"id", "box"}}, {{"id", "moving"}}, {{"id", "sizes"}}};
  info["methods"] = {"ramp", "<b>flat"};
  info["metrics"] = {"relmse"};
  run.write_run_json(info);
  return run.path();
}

}  // namespace test_results

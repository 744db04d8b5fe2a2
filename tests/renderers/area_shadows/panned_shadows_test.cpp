#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/renderers/area_shadows/shadow_bench.h"

/// M11: a camera that moves by tenths of a pixel. What every pixel by itself shows of a penumbra
/// moves along evenly; fragments may come and go, but must not be seen to.
namespace renderers::test {
namespace {

constexpr int kSide_px = 64;
constexpr int kFrames = 12;

/// Largest change of a pixel from frame to frame, by the mean of the picture.
double largest_change(const ShadowBench& bench, const std::string& renderer,
                      const std::vector<std::string>& settings) {
  const scene::Scene scene = bench.scene();
  double largest = 0.0;
  double mean = 0.0;
  std::vector<float> before;
  for (int frame = 0; frame < kFrames; ++frame) {
    RenderRequest request{.renderer = renderer,
                          .settings = settings,
                          .width_px = kSide_px,
                          .height_px = kSide_px,
                          .samples = 0};
    // The picture shows the floor from -1 to 1 m.
    const float shift_m = 0.1F * static_cast<float>(frame) * 2.0F / kSide_px;
    request.change_job = [&](RenderJob& job) {
      job.camera.position.x += shift_m;
      job.camera.look_at.x += shift_m;
    };
    const std::vector<float> pixels = render(scene, request).radiance.pixels;
    for (std::size_t i = 0; i < before.size(); ++i) {
      largest = std::max(largest, std::fabs(static_cast<double>(pixels[i] - before[i])));
    }
    for (const float value : pixels) {
      mean += static_cast<double>(value) / static_cast<double>(pixels.size() * kFrames);
    }
    before = pixels;
  }
  return largest / mean;
}

TEST(PannedShadows, FragmentsComeAndGoUnseen) {
  ShadowBench bench;
  bench.half_lamp_m = 0.1;
  bench.angle_rad = 0.4;
  const double reference = largest_change(bench, "per-pixel-shadows", {});
  const double best = largest_change(bench, "multires-shadows", {});
  const double nichols = largest_change(bench, "nichols-shadows", {});
  // The control: pixels take their fragment's value, and fragments are coarse.
  const double nearest =
      largest_change(bench, "multires-shadows", {"upsampling=nearest", "bit_threshold=12"});
  EXPECT_GT(reference, 0.05);
  EXPECT_LE(best, 2.5 * reference);
  EXPECT_LE(nichols, 1.5 * reference);
  EXPECT_GT(nearest, 4.0 * reference);
}

}  // namespace
}  // namespace renderers::test

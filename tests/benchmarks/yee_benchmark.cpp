// Time of `yee` beside OpenImageIO's compare_Yee, in one run on the same pair of 1920 x 1080
// images. Both get linear R, G, B; what the primaries are plays no part in the time.

#include <benchmark/benchmark.h>

#include <OpenImageIO/imagebufalgo.h>

#include <cstdint>

#include "metrics/metric_list.h"
#include "perception/base/parallel.h"

namespace {

using perception::Image;

constexpr int kWidthPx = 1920;
constexpr int kHeightPx = 1080;

/// Noise of the given amplitude about mid-grey.
Image noisy_picture(float amplitude) {
  Image image = perception::make_rgb_image(kWidthPx, kHeightPx, perception::Encoding::scene_linear);
  std::uint32_t state = 1;
  for (float& value : image.pixels) {
    state = state * 1664525U + 1013904223U;
    value = 0.4F + amplitude * (static_cast<float>(state >> 8) * 0x1p-24F - 0.5F);
  }
  return image;
}

void ours(benchmark::State& state) {
  const base::ThreadLimit limit(static_cast<int>(state.range(0)));
  const Image reference = noisy_picture(0.1F), test = noisy_picture(0.3F);
  const auto choice = metrics::parse_metric_choice("yee", {});
  for (auto _ : state) {
    benchmark::DoNotOptimize(metrics::score(choice, {reference, test}, {}).value);
  }
}

OIIO::ImageBuf buffer_of(const Image& image) {
  OIIO::ImageBuf buffer(OIIO::ImageSpec(kWidthPx, kHeightPx, 3, OIIO::TypeFloat));
  buffer.set_pixels(OIIO::ROI(), OIIO::TypeFloat, image.pixels.data());
  return buffer;
}

void openimageio(benchmark::State& state) {
  constexpr float kWhite_cd_m2 = 100.0F, kFov_deg = 45.0F;
  const OIIO::ImageBuf reference = buffer_of(noisy_picture(0.1F));
  const OIIO::ImageBuf test = buffer_of(noisy_picture(0.3F));
  const int threads = static_cast<int>(state.range(0));
  for (auto _ : state) {
    OIIO::ImageBufAlgo::CompareResults results;
    benchmark::DoNotOptimize(OIIO::ImageBufAlgo::compare_Yee(reference, test, results, kWhite_cd_m2,
                                                             kFov_deg, OIIO::ROI(), threads));
  }
}

// The argument is the number of threads, 0 for one per core.
BENCHMARK(ours)->Arg(1)->Arg(0)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(openimageio)->Arg(1)->Arg(0)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();

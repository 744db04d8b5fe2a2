// Time of every metric on a pair of 1920 x 1080 images, all cores.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "metrics/metric_list.h"
#include "perception/base/parallel.h"

namespace {

using perception::Encoding;
using perception::Image;

constexpr int kWidthPx = 1920;
constexpr int kHeightPx = 1080;

/// A smooth picture with noise of the given amplitude; display-encoded values are levels of 8 bits,
/// as PNG files hold them.
Image noisy_picture(Encoding encoding, float amplitude) {
  Image image = perception::make_rgb_image(kWidthPx, kHeightPx, encoding);
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    state = state * 1664525U + 1013904223U;
    const float noise = static_cast<float>(state >> 8) * 0x1p-24F - 0.5F;
    const auto phase = static_cast<float>(i % 5000) / 5000.0F;
    const float value = 0.5F + 0.4F * std::sin(6.2831853F * phase) + amplitude * 0.2F * noise;
    image.pixels[i] = encoding == Encoding::display ? std::round(value * 255.0F) / 255.0F : value;
  }
  return image;
}

void score_pair(benchmark::State& state, const std::string& metric, Encoding encoding,
                int threads) {
  const base::ThreadLimit limit(threads);
  const Image reference = noisy_picture(encoding, 0.0F);
  const Image test = noisy_picture(encoding, 1.0F);
  const auto choice = metrics::parse_metric_choice(metric, {});
  double value = 0.0;
  for (auto _ : state) {
    value = metrics::score(choice, {reference, test}, perception::ViewingConditions{}).value;
    benchmark::DoNotOptimize(value);
  }
  state.counters["value"] = value;
}

/// What no metric can beat: both images are read once, and a map is written.
void read_pair(benchmark::State& state, int threads) {
  const base::ThreadLimit limit(threads);
  const Image reference = noisy_picture(Encoding::scene_linear, 0.0F);
  const Image test = noisy_picture(Encoding::scene_linear, 1.0F);
  for (auto _ : state) {
    Image map = perception::make_gray_image(kWidthPx, kHeightPx, "error", Encoding::scene_linear);
    base::parallel_for(kHeightPx, 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin * kWidthPx; i < end * kWidthPx; ++i) {
        const float* r = &reference.pixels[3 * i];
        const float* x = &test.pixels[3 * i];
        map.pixels[i] = (x[0] - r[0]) + (x[1] - r[1]) + (x[2] - r[2]);
      }
    });
    benchmark::DoNotOptimize(map.pixels.data());
  }
}

/// One frame of a sequence, its predecessor included.
void score_frame(benchmark::State& state, const std::string& metric) {
  const std::vector<Image> reference(2, noisy_picture(Encoding::display, 0.0F));
  const std::vector<Image> test = {reference[0], noisy_picture(Encoding::display, 1.0F)};
  const auto choice = metrics::parse_sequence_metric_choice(metric, {});
  const auto judge = choice.info->create(choice.parameters);
  double value = 0.0;
  for (auto _ : state) {
    value = judge->evaluate({.reference = reference, .test = test}, {}).front().value;
    benchmark::DoNotOptimize(value);
  }
  state.counters["value"] = value;
}

}  // namespace

int main(int argument_count, char** arguments) {
  benchmark::Initialize(&argument_count, arguments);
  struct Case {
    std::string metric;
    Encoding encoding;
  };
  const Case cases[] = {
      {"mse", Encoding::scene_linear},
      {"relmse", Encoding::scene_linear},
      {"relative-rmse", Encoding::scene_linear},
      {"mae", Encoding::scene_linear},
      {"smape", Encoding::scene_linear},
      {"psnr", Encoding::display},
      {"psnr", Encoding::scene_linear},
      {"ssim", Encoding::display},
      {"ms-ssim", Encoding::display},
      {"delta-e-2000", Encoding::display},
      {"pu-psnr", Encoding::display},
      {"pu-ssim", Encoding::display},
      {"pu-ms-ssim", Encoding::display},
      {"cvvdp", Encoding::display},
      {"cvvdp", Encoding::scene_linear},
      {"daly-vdp", Encoding::display},
      {"daly-vdp", Encoding::scene_linear},
      {"flip", Encoding::display},
      {"flip,exposures=4", Encoding::scene_linear},
      {"visible-difference", Encoding::display},
      {"visible-difference", Encoding::scene_linear},
      {"visible-difference,masking=joint", Encoding::display},
      {"threshold-ratio", Encoding::display},
      {"yee", Encoding::display},
      {"contrast-kept", Encoding::scene_linear},
      {"edge-excess", Encoding::display},
      {"holes", Encoding::scene_linear},
      {"leak", Encoding::scene_linear},
      {"penumbra-width", Encoding::scene_linear},
  };
  for (const int threads : {1, 0}) {
    const char* name = threads == 1 ? "memory_bound/one_thread" : "memory_bound/all_cores";
    benchmark::RegisterBenchmark(name, read_pair, threads)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
  for (const Case& one : cases) {
    for (const int threads : {1, 0}) {
      const std::string name = one.metric +
                               (one.encoding == Encoding::display ? "/display" : "/linear") +
                               (threads == 1 ? "/one_thread" : "/all_cores");
      benchmark::RegisterBenchmark(name.c_str(), score_pair, one.metric, one.encoding, threads)
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    }
  }
  benchmark::RegisterBenchmark("flicker/display/all_cores", score_frame, "flicker")
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
  benchmark::RunSpecifiedBenchmarks();
}

#include "renderers/path_tracing/film.h"

#include <algorithm>
#include <cassert>

namespace renderers::path_tracing {

namespace {

using perception::Image;

/// Samples dealt to a randomisation among the first `samples`.
std::int64_t samples_of(std::uint32_t randomisation, std::int64_t samples) {
  return (samples + kRandomisations - 1 - randomisation) / kRandomisations;
}

}  // namespace

Film::Film(int width_px, int height_px)
    : width_px_(width_px),
      height_px_(height_px),
      pixels_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)) {}

std::uint64_t Film::needed_bytes(int width_px, int height_px, std::int64_t samples) {
  // radiance, direct, indirect, albedo, normal, depth, and where there are two samples variance.
  const std::uint64_t channels = samples >= 2 ? 19 : 16;
  const std::uint64_t sums =
      sizeof(PixelSums) + sizeof(glm::dvec3) * static_cast<std::uint64_t>(std::clamp<std::int64_t>(
                                                   samples, 1, kRandomisations));
  return static_cast<std::uint64_t>(width_px) * static_cast<std::uint64_t>(height_px) *
         (sums + channels * sizeof(float));
}

void Film::reserve(std::int64_t samples) {
  const auto needed = static_cast<std::size_t>(std::min<std::int64_t>(samples, kRandomisations));
  while (radiance_.size() < needed) radiance_.emplace_back(pixels_.size(), glm::dvec3(0.0));
}

void Film::add(std::size_t pixel, std::int64_t sample_index, const PathSample& sample) {
  PixelSums& sums = pixels_[pixel];
  const glm::dvec3 direct(sample.direct);
  const glm::dvec3 indirect(sample.indirect);
  sums.direct += direct;
  sums.indirect += indirect;
  radiance_[static_cast<std::size_t>(sample_index % kRandomisations)][pixel] += direct + indirect;
  if (!sample.has_surface) return;
  sums.albedo += glm::dvec3(sample.albedo);
  sums.normal += glm::dvec3(sample.normal);
  sums.depth_m += static_cast<double>(sample.depth_m);
  sums.surfaces += 1;
}

template <typename Value>
Image Film::rgb_image(const Value& value) const {
  Image image =
      perception::make_rgb_image(width_px_, height_px_, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const glm::vec3 color(value(i));
    std::copy_n(&color.x, 3, image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return image;
}

Image Film::radiance(std::int64_t samples) const {
  const double weight = 1.0 / static_cast<double>(samples);
  return rgb_image(
      [&](std::size_t i) { return weight * (pixels_[i].direct + pixels_[i].indirect); });
}

Image Film::direct(std::int64_t samples) const {
  const double weight = 1.0 / static_cast<double>(samples);
  return rgb_image([&](std::size_t i) { return weight * pixels_[i].direct; });
}

Image Film::indirect(std::int64_t samples) const {
  const double weight = 1.0 / static_cast<double>(samples);
  return rgb_image([&](std::size_t i) { return weight * pixels_[i].indirect; });
}

Image Film::variance(std::int64_t samples) const {
  assert(samples >= 2);
  const auto n = static_cast<double>(samples);
  const auto used = static_cast<double>(radiance_.size());
  return rgb_image([&](std::size_t i) {
    glm::dvec3 mean(0.0);
    for (const auto& sums : radiance_) mean += sums[i];
    mean /= n;
    glm::dvec3 spread(0.0);
    for (std::uint32_t b = 0; b < radiance_.size(); ++b) {
      const auto size = static_cast<double>(samples_of(b, samples));
      const glm::dvec3 difference = radiance_[b][i] / size - mean;
      spread += size * difference * difference;
    }
    return spread / ((used - 1.0) * n);
  });
}

std::vector<perception::NamedImage> Film::first_surface(std::int64_t samples) const {
  const double weight = 1.0 / static_cast<double>(samples);
  Image albedo = rgb_image([&](std::size_t i) { return weight * pixels_[i].albedo; });
  Image normal = rgb_image([&](std::size_t i) { return weight * pixels_[i].normal; });
  normal.channels = {"X", "Y", "Z"};
  Image depth =
      perception::make_gray_image(width_px_, height_px_, "Z", perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const PixelSums& sums = pixels_[i];
    if (sums.surfaces == 0) continue;
    depth.pixels[i] = static_cast<float>(sums.depth_m / static_cast<double>(sums.surfaces));
  }
  return {
      {"albedo", std::move(albedo)}, {"normal", std::move(normal)}, {"depth", std::move(depth)}};
}

}  // namespace renderers::path_tracing

#include "suites/score_images.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "perception/base/atomic_file.h"
#include "perception/base/hash.h"

namespace suites {
namespace {

using perception::Image;
using perception::NamedImage;

/// From where on a value of a mask counts, and a step of an AOV is an edge.
constexpr float kThreshold = 0.5F;

/// @throws base::InputError naming the AOVs that there are
const Image& aov_of(const std::vector<const NamedImage*>& aovs, const std::string& name,
                    const std::string& whose) {
  std::vector<std::string> names;
  for (const NamedImage* aov : aovs) {
    if (aov->name == name) return aov->image;
    names.push_back(aov->name);
  }
  throw base::InputError(
      fmt::format("{} has no AOV \"{}\"; it has: {}", whose, name,
                  names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

const Image& aov_of(const Reference& reference, const std::string& name) {
  const NamedImage indirect{"indirect", {}};
  if (name == indirect.name && !reference.indirect.is_empty()) return reference.indirect;
  std::vector<const NamedImage*> aovs;
  for (const NamedImage& aov : reference.aovs) aovs.push_back(&aov);
  if (!reference.indirect.is_empty()) aovs.push_back(&indirect);
  return aov_of(aovs, name, "the reference (only an `own` one keeps more than \"indirect\")");
}

Image scaled(Image image, double scale) {
  if (scale == 1.0) return image;
  for (float& value : image.pixels) value *= static_cast<float>(scale);
  return image;
}

bool differs(const Image& image, std::size_t a, std::size_t b) {
  for (std::size_t channel = 0; channel < image.channels.size(); ++channel) {
    if (std::abs(image.pixels[a + channel] - image.pixels[b + channel]) > kThreshold) return true;
  }
  return false;
}

Image empty_mask(const Image& image) {
  return perception::make_gray_image(image.width_px, image.height_px, "mask",
                                     perception::Encoding::scene_linear);
}

/// Both sides of every step.
Image steps_of(const Image& image) {
  Image steps = empty_mask(image);
  const auto mark = [&](int x, int y, int to_x, int to_y) {
    if (to_x >= image.width_px || to_y >= image.height_px) return;
    if (!differs(image, image.offset(x, y), image.offset(to_x, to_y))) return;
    steps.at(x, y) = 1.0F;
    steps.at(to_x, to_y) = 1.0F;
  };
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      mark(x, y, x + 1, y);
      mark(x, y, x, y + 1);
    }
  }
  return steps;
}

/// The greatest value up to a distance along one axis.
Image spread(const Image& mask, int distance_px, bool is_along_x) {
  Image wide = empty_mask(mask);
  for (int y = 0; y < mask.height_px; ++y) {
    for (int x = 0; x < mask.width_px; ++x) {
      const int last = (is_along_x ? mask.width_px : mask.height_px) - 1;
      const int center = is_along_x ? x : y;
      float value = 0.0F;
      for (int i = std::max(0, center - distance_px); i <= std::min(last, center + distance_px);
           ++i) {
        value = std::max(value, is_along_x ? mask.at(i, y) : mask.at(x, i));
      }
      wide.at(x, y) = value;
    }
  }
  return wide;
}

/// 1 where the greatest channel is above the threshold.
Image above_threshold(const Image& image) {
  Image mask = empty_mask(image);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const auto pixel = image.pixel(x, y);
      const bool counts =
          std::any_of(pixel.begin(), pixel.end(), [](float value) { return value > kThreshold; });
      mask.at(x, y) = counts ? 1.0F : 0.0F;
    }
  }
  return mask;
}

}  // namespace

Image seen_picture(const SuiteMetric& metric, const std::vector<NamedImage>& parts) {
  if (metric.image.empty()) return parts.front().image;
  std::vector<const NamedImage*> aovs;
  for (std::size_t i = 1; i < parts.size(); ++i) aovs.push_back(&parts[i]);
  return scaled(perception::rgb_of(aov_of(aovs, metric.image, "the picture")), metric.scale);
}

Image seen_reference(const SuiteMetric& metric, const Reference& reference, renderers::Part part) {
  if (metric.image.empty()) return reference.image(part);
  return scaled(perception::rgb_of(aov_of(reference, metric.image)), metric.scale);
}

std::optional<Image> mask_image(const SuiteMetric& metric, const Reference& reference) {
  const MaskSpec& mask = metric.mask;
  switch (mask.kind) {
    case MaskSpec::Kind::edges:
      return near_steps(aov_of(reference, mask.aov), mask.distance_px);
    case MaskSpec::Kind::interior: {
      Image edges = near_steps(aov_of(reference, mask.aov), mask.distance_px);
      for (float& value : edges.pixels) value = 1.0F - value;
      return edges;
    }
    case MaskSpec::Kind::above_half:
      return above_threshold(mask.aov.empty() ? perception::read_image(mask.file)
                                              : aov_of(reference, mask.aov));
    case MaskSpec::Kind::none:
      break;
  }
  return std::nullopt;
}

std::string mask_file_hash(const SuiteMetric& metric) {
  if (metric.mask.file.empty()) return {};
  return base::hash_of(base::read_text_file(metric.mask.file)).hex();
}

Image near_steps(const Image& image, int distance_px) {
  return spread(spread(steps_of(image), distance_px, true), distance_px, false);
}

}  // namespace suites

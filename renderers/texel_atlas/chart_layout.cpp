#include "renderers/texel_atlas/chart_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "perception/base/errors.h"

namespace renderers::texel_atlas {

namespace {

/// Whole texels of a length; a length that is whole up to rounding does not get one more.
int texels_of(double length_m, double texels_per_m) {
  constexpr double kRounding = 1e-6;
  const double texels = std::ceil(length_m * texels_per_m - kRounding);
  constexpr double kMost = 1 << 24;
  return static_cast<int>(std::clamp(texels, 1.0, kMost));
}

ChartPlace place_of(const Chart& chart, double texels_per_m) {
  ChartPlace place;
  for (int axis = 0; axis < 2; ++axis) {
    place.size[axis] = texels_of(chart.size_m[axis], texels_per_m);
    place.texels_per_m[axis] = static_cast<double>(place.size[axis]) / chart.size_m[axis];
  }
  return place;
}

/// One attempt. @param order  charts by falling height
/// @return nothing if they do not fit
std::optional<std::vector<ChartPlace>> pack(std::span<const Chart> charts,
                                            const std::vector<std::uint32_t>& order,
                                            const LayoutSettings& settings, double texels_per_m) {
  std::vector<ChartPlace> places(charts.size());
  std::int64_t x = 0;
  std::int64_t shelf = 0;
  std::int64_t next_shelf = 0;
  for (const std::uint32_t i : order) {
    ChartPlace& place = places[i];
    place = place_of(charts[i], texels_per_m);
    if (place.size.x > settings.side_px) return std::nullopt;
    if (x + place.size.x > settings.side_px) {
      x = 0;
      shelf = next_shelf + settings.padding_px;
    }
    if (shelf + place.size.y > settings.side_px) return std::nullopt;
    place.corner = {static_cast<int>(x), static_cast<int>(shelf)};
    next_shelf = std::max(next_shelf, shelf + place.size.y);
    x += place.size.x + settings.padding_px;
  }
  return places;
}

std::vector<std::uint32_t> by_falling_height(std::span<const Chart> charts) {
  std::vector<std::uint32_t> order(charts.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return charts[a].size_m.y > charts[b].size_m.y;
  });
  return order;
}

double total_area_m2(std::span<const Chart> charts) {
  double sum = 0.0;
  for (const Chart& chart : charts) sum += chart.size_m.x * chart.size_m.y;
  return sum;
}

}  // namespace

ChartLayout lay_out(std::span<const Chart> charts, const LayoutSettings& settings) {
  ChartLayout layout;
  layout.side_px = settings.side_px;
  layout.texels_per_m = settings.texels_per_m;
  if (charts.empty()) return layout;
  const std::vector<std::uint32_t> order = by_falling_height(charts);
  const auto attempt = [&](double texels_per_m) {
    return pack(charts, order, settings, texels_per_m);
  };
  // Between nothing and more than the area allows; halved until a hundredth of a per cent.
  double fits = 0.0;
  double fails =
      std::sqrt(static_cast<double>(settings.side_px) * settings.side_px / total_area_m2(charts)) *
      1.01;
  std::optional<std::vector<ChartPlace>> best = attempt(0.0);
  if (!best) {
    throw base::InputError(fmt::format(
        "texel atlas: {} charts of scene \"{}\" do not fit into {} x {} texels, not even with a "
        "texel each; accepted: a larger atlas_side, or charts=connected",
        charts.size(), settings.scene_name, settings.side_px, settings.side_px));
  }
  while (fails - fits > 1e-4 * fails) {
    const double middle = 0.5 * (fits + fails);
    auto places = attempt(middle);
    (places ? fits : fails) = middle;
    if (places) best = std::move(places);
  }
  if (settings.texels_per_m > 0.0) {
    best = attempt(settings.texels_per_m);
    if (!best) {
      throw base::InputError(fmt::format(
          "texel atlas: scene \"{}\" ({:.4g} m2 of charts) does not fit into {} x {} texels at {} "
          "texels per metre; accepted: at most {:.4g}, or a larger atlas_side",
          settings.scene_name, total_area_m2(charts), settings.side_px, settings.side_px,
          settings.texels_per_m, fits));
    }
  } else {
    layout.texels_per_m = fits;
  }
  layout.places = std::move(*best);
  return layout;
}

}  // namespace renderers::texel_atlas

#include "suites/picture_memory.h"

#include <algorithm>

#include <fmt/format.h>

namespace suites {

namespace {

/// So little is not worth a refusal: what is said to be available is an estimate.
constexpr double kAlwaysThere_bytes = 256.0 * (1 << 20);

}  // namespace

std::size_t channel_count(const renderers::Frame& frame) {
  std::size_t channels = frame.radiance.channels.size();
  for (const perception::NamedImage& aov : frame.aovs) channels += aov.image.channels.size();
  return channels;
}

std::optional<std::string> lack_of_memory(const base::SizePx& size_px, std::size_t channels,
                                          std::size_t copies,
                                          std::optional<std::int64_t> available_bytes) {
  if (!available_bytes) return std::nullopt;
  const double need_bytes = static_cast<double>(size_px.width) *
                            static_cast<double>(size_px.height) * sizeof(float) *
                            static_cast<double>(channels) * static_cast<double>(copies);
  const auto have_bytes = static_cast<double>(*available_bytes);
  if (need_bytes <= std::max(have_bytes, kAlwaysThere_bytes)) return std::nullopt;
  return fmt::format(
      "a picture of {}x{} pixels takes at least {} of memory ({} channels of {} bytes, {} copies); "
      "{} are available; accepted: a smaller size, or a machine with more memory",
      size_px.width, size_px.height, base::format_bytes(need_bytes), channels, sizeof(float),
      copies, base::format_bytes(have_bytes));
}

}  // namespace suites

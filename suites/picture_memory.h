#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "perception/base/units.h"
#include "renderers/contract/renderer.h"

namespace suites {

/// Channels of the radiance and all AOVs of a frame.
std::size_t channel_count(const renderers::Frame& frame);

/// Why a picture is not begun: it cannot fit. What it takes at least is a float per pixel and
/// channel, in so many copies; a renderer's own sums come on top.
///
/// @param channels         of all images together, at least 3
/// @param copies           held at once: 2 for a picture as rendered and as it is written
/// @param available_bytes  see `base::available_memory_bytes`; nothing: not known, all may fit
/// @return a sentence with need and have; nothing if it may fit
std::optional<std::string> lack_of_memory(const base::SizePx& size_px, std::size_t channels,
                                          std::size_t copies,
                                          std::optional<std::int64_t> available_bytes);

}  // namespace suites

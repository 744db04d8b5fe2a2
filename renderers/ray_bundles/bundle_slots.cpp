#include <algorithm>
#include <atomic>

#include "perception/base/parallel.h"
#include "renderers/ray_bundles/bundle_raster.h"

namespace renderers::ray_bundles {

SlotCounts BundleRaster::fill_slots(const BundleFrame& frame, const SlotSettings& settings,
                                    BundleLists& lists) {
  lists.reset(frame);
  const std::size_t bands = lists.band_count();
  if (slot_bands_.size() < bands) slot_bands_.resize(bands);
  const auto slots = static_cast<std::uint32_t>(settings.slots);
  SlotCounts counts;
  bool is_complete = false;
  while (!is_complete) {
    // Drawn anew each time, as a device has to: nothing of the pass before is kept but the slots.
    draw_all(frame, bands);
    const auto pass = static_cast<std::uint32_t>(counts.passes++);
    std::atomic<bool> has_more = false;
    base::parallel_for(bands, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t band = begin; band < end; ++band) {
        capture(frame, band, pass, slots);
        const auto& fragments = slot_bands_[band].fragments;
        const auto most = std::max_element(fragments.begin(), fragments.end());
        if (most != fragments.end() && *most > (pass + 1) * slots) has_more = true;
      }
    });
    is_complete = !settings.until_complete || !has_more;
  }
  std::atomic<std::uint64_t> dropped = 0;
  base::parallel_for(bands, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band) {
      dropped += join_slots(frame, band, slots, lists.band(band));
    }
  });
  counts.dropped = dropped;
  return counts;
}

/// One pass over a band: of each line, the fragments that it has slots for.
void BundleRaster::capture(const BundleFrame& frame, std::size_t index, std::uint32_t pass,
                           std::uint32_t slots) {
  const int first_row = static_cast<int>(index) * BundleLists::kBandRows;
  const int rows = std::min(BundleLists::kBandRows, frame.height_px - first_row);
  const auto width = static_cast<std::size_t>(frame.width_px);
  const std::size_t lines = static_cast<std::size_t>(rows) * width;
  SlotBand& band = slot_bands_[index];
  if (pass == 0) band.passes.clear();
  band.passes.emplace_back(lines * slots);
  std::vector<ListNode>& nodes = band.passes.back();
  band.fragments.assign(lines, 0);
  const std::uint32_t first = pass * slots;
  for (const Chunk& chunk : chunks_) {
    for (const Span& span : chunk.bands[index]) {
      const std::size_t row = static_cast<std::size_t>(span.row - first_row) * width;
      for (int x = span.begin; x < span.end; ++x) {
        const std::size_t line = row + static_cast<std::size_t>(x);
        const std::uint32_t fragment = band.fragments[line]++;
        if (fragment < first || fragment - first >= slots) continue;
        nodes[line * slots + fragment - first] = node_of(span, chunk.planes[span.plane], x);
      }
    }
  }
}

/// The slots of all passes, line after line. @return fragments that had none
std::uint64_t BundleRaster::join_slots(const BundleFrame& frame, std::size_t index,
                                       std::uint32_t slots, BundleLists::Band& band) const {
  const SlotBand& source = slot_bands_[index];
  const auto most = static_cast<std::uint32_t>(source.passes.size()) * slots;
  std::uint64_t dropped = 0;
  thread_local std::vector<std::uint32_t> ends;
  ends.clear();
  for (std::size_t line = 0; line < source.fragments.size(); ++line) {
    const std::uint32_t count = std::min(source.fragments[line], most);
    dropped += source.fragments[line] - count;
    for (std::uint32_t i = 0; i < count; ++i) {
      band.nodes.push_back(source.passes[i / slots][line * slots + i % slots]);
    }
    ends.push_back(static_cast<std::uint32_t>(band.nodes.size()));
  }
  order_lines(frame, ends, band);
  return dropped;
}

}  // namespace renderers::ray_bundles

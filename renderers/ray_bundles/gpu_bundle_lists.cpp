#include "renderers/ray_bundles/gpu_bundle_lists.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <optional>
#include <utility>

#include <fmt/core.h>
#include <glm/vec4.hpp>

#include "perception/base/errors.h"
#include "perception/base/parallel.h"
#include "renderers/opengl/framebuffer.h"
#include "renderers/opengl/gpu_stage.h"
#include "renderers/ray_bundles/gpu_dispatch.h"

namespace renderers::ray_bundles {

namespace {

/// std430, shaders/bundle_triangles.glsl.
struct SourceTriangle {
  glm::vec4 corners[3];
  glm::vec4 along;
  glm::ivec4 rectangle;
};

constexpr std::size_t kPlaneBytes = 5 * sizeof(glm::vec4);  // TrianglePlane of the same file
constexpr std::size_t kWordBytes = sizeof(std::uint32_t);
constexpr std::uint32_t kNoWord = 0xffffffffU;
constexpr std::uint32_t kAll = 0xffffffffU;
/// How far rounding to 1/256 pixel moves a corner.
constexpr float kEdgeMargin_px = 1.0F / 512.0F;

/// Those with a place in the atlas, as words of the lists number them.
std::vector<const texel_atlas::WorldTriangle*> placed_triangles(
    const texel_atlas::WorldTriangles& world, const texel_atlas::TexelAtlas& atlas) {
  std::vector<const texel_atlas::WorldTriangle*> placed;
  placed.reserve(world.triangles.size());
  for (const texel_atlas::WorldTriangle& triangle : world.triangles) {
    const texel_atlas::TriangleMap& map = atlas.map_of(triangle.object, triangle.triangle);
    if (map.chart != texel_atlas::kNoTexel) placed.push_back(&triangle);
  }
  return placed;
}

std::vector<SourceTriangle> source_triangles(const texel_atlas::WorldTriangles& world,
                                             const texel_atlas::TexelAtlas& atlas) {
  std::vector<SourceTriangle> sources;
  sources.reserve(world.triangles.size());
  for (const texel_atlas::WorldTriangle* triangle : placed_triangles(world, atlas)) {
    const texel_atlas::TriangleMap& map = atlas.map_of(triangle->object, triangle->triangle);
    const texel_atlas::ChartPlace& place = atlas.layout().places[map.chart];
    SourceTriangle& source = sources.emplace_back();
    const float w[3] = {map.corner.x, map.corner.y, 0.0F};
    for (int i = 0; i < 3; ++i) source.corners[i] = {glm::vec3(triangle->corners[i]), w[i]};
    source.along = {map.along_u, map.along_v};
    source.rectangle = {place.corner, place.size};
  }
  return sources;
}

/// Every cell of a chart's rectangle with the texel that stands for points there; rectangles are
/// apart.
std::vector<std::uint32_t> cells_of(const texel_atlas::TexelAtlas& atlas) {
  const auto side = static_cast<std::size_t>(atlas.layout().side_px);
  std::vector<std::uint32_t> cells(side * side, texel_atlas::kNoTexel);
  for (std::uint32_t chart = 0; chart < atlas.layout().places.size(); ++chart) {
    const texel_atlas::ChartPlace& place = atlas.layout().places[chart];
    for (int y = place.corner.y; y < place.corner.y + place.size.y; ++y) {
      for (int x = place.corner.x; x < place.corner.x + place.size.x; ++x) {
        cells[static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x)] =
            atlas.texel_at_position(chart, {x, y});
      }
    }
  }
  return cells;
}

std::vector<glm::vec4> attitudes_of(const texel_atlas::TexelAtlas& atlas) {
  std::vector<glm::vec4> attitudes;
  attitudes.reserve(atlas.texels().size());
  for (const texel_atlas::Texel& texel : atlas.texels()) {
    attitudes.emplace_back(texel.point.geometric_normal, std::bit_cast<float>(texel.point.object));
  }
  return attitudes;
}

}  // namespace

GpuBundleLists::GpuBundleLists(std::shared_ptr<opengl::Context> context,
                               const texel_atlas::WorldTriangles& world,
                               const texel_atlas::TexelAtlas& atlas, std::int64_t most_block_bytes)
    : context_(std::move(context)),
      most_block_bytes_(most_block_bytes > 0 ? most_block_bytes
                                             : context_->limits().storage_block_bytes),
      atlas_side_px_(atlas.layout().side_px),
      faults_(context_, 2 * kWordBytes),
      prefix_sum_(context_) {
  require(list_needs(true));
  const std::vector<SourceTriangle> sources = source_triangles(world, atlas);
  const auto side = static_cast<std::size_t>(atlas_side_px_);
  require_block("triangles", sources.size(), sizeof(SourceTriangle));
  require_block("cells of the atlas", side * side, kWordBytes);
  require_block("texels", atlas.texels().size(), sizeof(glm::vec4));
  triangle_count_ = static_cast<int>(sources.size());
  triangles_ = opengl::Buffer::of<SourceTriangle>(context_, sources);
  cells_ = opengl::Buffer::of<std::uint32_t>(context_, cells_of(atlas));
  texels_ = opengl::Buffer::of<glm::vec4>(context_, attitudes_of(atlas));
  planes_ = opengl::Buffer(context_, std::max<std::size_t>(1, sources.size()) * kPlaneBytes);
}

std::int64_t GpuBundleLists::scene_block_bytes(std::size_t triangles,
                                               const texel_atlas::TexelAtlas& atlas) {
  // A hierarchy has fewer than two boxes for each triangle.
  static_assert(2 * sizeof(gpu_tracing::BvhNode) <= sizeof(SourceTriangle));
  const auto side = static_cast<std::size_t>(atlas.layout().side_px);
  return static_cast<std::int64_t>(
      std::max({triangles * sizeof(SourceTriangle), side * side * kWordBytes,
                atlas.texels().size() * sizeof(glm::vec4)}));
}

GpuLineTracer& GpuBundleLists::use_rays(const texel_atlas::WorldTriangles& world,
                                        const texel_atlas::TexelAtlas& atlas, StageTimer& timer) {
  std::vector<gpu_tracing::BvhTriangle> triangles;
  for (const texel_atlas::WorldTriangle* triangle : placed_triangles(world, atlas)) {
    const auto corner = [&](std::size_t i) { return glm::vec3(triangle->corners[i]); };
    triangles.push_back({corner(0), triangle->object, corner(1),
                         static_cast<std::uint32_t>(triangles.size()), corner(2), 0});
  }
  gpu_tracing::TriangleBvh bvh;
  {
    const auto stage = timer.stage("bvh");
    bvh = gpu_tracing::build_bvh(triangles);
  }
  tracer_ = std::make_unique<GpuLineTracer>(context_, bvh, timer);
  return *tracer_;
}

void GpuBundleLists::require(const DeviceNeeds& needs) const {
  const std::string lack = lacking(needs, context_->limits(), context_->facts().renderer);
  if (!lack.empty()) throw UnsupportedError("ray-bundles: " + lack + "; accepted: backend cpu");
}

void GpuBundleLists::require_block(const std::string& what, std::size_t count,
                                   std::size_t element_bytes) const {
  if (count * element_bytes <= static_cast<std::size_t>(most_block_bytes_)) return;
  throw UnsupportedError(fmt::format(
      "ray-bundles: {} {} take {} bytes; {} allows a storage block {}; accepted: backend cpu, or "
      "fewer",
      count, what, count * element_bytes, context_->facts().renderer, most_block_bytes_));
}

void GpuBundleLists::begin_frame(const BundleFrame& frame) {
  if (!tracer_) require(list_needs(false));
  faults_.fill(0);
  opengl::Program& program = compute_program(*context_, "bundle_planes");
  program.storage(0, triangles_);
  program.storage(1, planes_);
  set_frame(program, frame);
  program.set("triangle_count", static_cast<std::uint32_t>(triangle_count_));
  dispatch_items(program, triangle_count_);
}

/// As many as have their buffers, of which the largest takes so much per line, in a storage block.
int GpuBundleLists::rows_that_fit(const BundleFrame& frame, std::int64_t line_bytes) const {
  const std::int64_t row_bytes = frame.width_px * line_bytes;
  const std::int64_t rows = (most_block_bytes_ - static_cast<std::int64_t>(kWordBytes)) / row_bytes;
  return static_cast<int>(std::clamp<std::int64_t>(rows, 1, frame.height_px));
}

opengl::Program& GpuBundleLists::fragment_program(const std::string& pass,
                                                  opengl::Defines defines) {
  return context_->program(
      {shader_files(), {shader_path("bundle.vert"), shader_path(pass)}, std::move(defines)});
}

void GpuBundleLists::draw(opengl::Program& program, const BundleFrame& frame,
                          const LineRows& rows) {
  const opengl::Framebuffer target(context_, {frame.width_px, rows.count()}, 0);
  opengl::RasterPass pass(target, opengl::DepthTest::none, 0);
  // The viewport is the whole raster, moved: rows are the same but where a driver that rounds
  // corners after the move rounds them elsewhere.
  pass.viewport({0, -rows.begin}, {frame.width_px, frame.height_px});
  program.storage(0, triangles_);
  set_frame(program, frame);
  program.set("size_px", glm::vec2(frame.width_px, frame.height_px));
  program.set("width_px", frame.width_px);
  program.draw_triangles(0, 3 * triangle_count_);
}

bool GpuBundleLists::can_hold(const BundleFrame& frame, const LineRows& rows,
                              const CountTotals& totals) const {
  const std::int64_t needed_bytes =
      static_cast<std::int64_t>(totals.sum) * static_cast<std::int64_t>(sizeof(ListNode));
  if (needed_bytes <= most_block_bytes_) return true;
  if (rows.count() > 1) return false;
  throw UnsupportedError(fmt::format(
      "ray-bundles: the {} crossings of {} lines take {} bytes; {} allows a storage block {}; "
      "accepted: backend cpu, or fewer lines",
      totals.sum, frame.width_px, needed_bytes, context_->facts().renderer, most_block_bytes_));
}

/// Rows by rows, halved where they hold too many crossings and begun anew.
SlotCounts GpuBundleLists::fill_rows(const BundleFrame& frame, std::int64_t line_bytes,
                                     BundleLists& lists, StageTimer& timer, const DrawRows& draw,
                                     bool is_counted) {
  require_block("bytes of a row of lines", static_cast<std::size_t>(frame.width_px * line_bytes),
                1);
  lists.reset(frame);
  SlotCounts counts;
  int step = rows_that_fit(frame, line_bytes);
  for (int begin = 0; begin < frame.height_px;) {
    const LineRows rows{begin, std::min(frame.height_px, begin + step)};
    {
      const opengl::GpuStage stage(*context_, timer, finding_stage());
      if (begin == 0) begin_frame(frame);
      const std::optional<SlotCounts> drawn = draw(rows);
      if (!drawn) {
        step = (rows.count() + 1) / 2;
        continue;
      }
      counts.passes = std::max(counts.passes, drawn->passes);
      counts.dropped += drawn->dropped;
    }
    {
      const opengl::GpuStage stage(*context_, timer, "order");
      order(frame, rows, is_counted);
    }
    const auto stage = timer.stage("copy");
    copy(frame, rows, lists);
    begin = rows.end;
  }
  context_->check("making the lists of a bundle");
  return counts;
}

/// Places for the words of the lists. @return false if the rows' crossings do not fit
bool GpuBundleLists::place_lists(const BundleFrame& frame, const LineRows& rows,
                                 const CountTotals& totals) {
  if (!can_hold(frame, rows, totals)) return false;
  words_.reserve(context_, std::max(1U, totals.sum) * kWordBytes);
  nodes_.reserve(context_, std::max(1U, totals.sum) * sizeof(ListNode));
  crossings_ = totals.sum;
  return true;
}

SlotCounts GpuBundleLists::fill(const BundleFrame& frame, BundleLists& lists, StageTimer& timer) {
  return fill_rows(
      frame, kWordBytes, lists, timer,
      [&](const LineRows& rows) { return draw_counted(frame, rows); }, true);
}

void GpuBundleLists::count_crossings(const BundleFrame& frame, const LineRows& rows) {
  if (tracer_) {
    tracer_->count(frame, rows, counts_);
    return;
  }
  opengl::Program& program = fragment_program("bundle_count.frag");
  program.storage(2, counts_);
  draw(program, frame, rows);
}

void GpuBundleLists::fill_words(const BundleFrame& frame, const LineRows& rows) {
  if (tracer_) {
    tracer_->fill(frame, rows, counts_, starts_, words_);
    return;
  }
  opengl::Program& program = fragment_program("bundle_fill.frag");
  program.storage(2, counts_);
  program.storage(3, starts_);
  program.storage(4, words_);
  draw(program, frame, rows);
}

std::optional<SlotCounts> GpuBundleLists::draw_counted(const BundleFrame& frame,
                                                       const LineRows& rows) {
  const std::size_t lines = line_count(frame, rows);
  counts_.reserve(context_, lines * kWordBytes);
  counts_.fill(0);
  count_crossings(frame, rows);
  const CountTotals totals =
      prefix_sum_.run(counts_, static_cast<std::int64_t>(lines), kAll, starts_);
  if (!place_lists(frame, rows, totals)) return std::nullopt;
  fill_words(frame, rows);
  return SlotCounts{2, 0};
}

SlotCounts GpuBundleLists::fill_slots(const BundleFrame& frame, const SlotSettings& settings,
                                      BundleLists& lists, StageTimer& timer) {
  assert(!tracer_);
  const auto line_bytes = static_cast<std::int64_t>(kWordBytes) * settings.slots;
  return fill_rows(
      frame, line_bytes, lists, timer,
      [&](const LineRows& rows) { return draw_slots(frame, settings, rows); }, false);
}

std::optional<SlotCounts> GpuBundleLists::draw_slots(const BundleFrame& frame,
                                                     const SlotSettings& settings,
                                                     const LineRows& rows) {
  const std::size_t lines = line_count(frame, rows);
  const auto slots = static_cast<std::uint32_t>(settings.slots);
  counts_.reserve(context_, lines * kWordBytes);
  counts_.fill(0);
  slots_.reserve(context_, lines * slots * kWordBytes);
  slots_.fill(kNoWord);
  first_words_.reserve(context_, lines * kWordBytes);
  first_words_.fill(0);
  CountTotals totals;
  std::uint32_t passes = 1;
  for (std::uint32_t pass = 0; pass < passes; ++pass) {
    opengl::Program& program = fragment_program("bundle_slots.frag");
    program.storage(2, counts_);
    program.storage(8, slots_);
    program.storage(9, first_words_);
    program.set("slot_count", slots);
    draw(program, frame, rows);
    if (pass == 0) {
      const std::uint32_t most = settings.until_complete ? kAll : slots;
      totals = prefix_sum_.run(counts_, static_cast<std::int64_t>(lines), most, starts_);
      if (!place_lists(frame, rows, totals)) return std::nullopt;
      if (settings.until_complete) passes = std::max(1U, (totals.most + slots - 1) / slots);
    }
    take_slots(static_cast<std::uint32_t>(lines), settings, pass);
  }
  return SlotCounts{passes, totals.over};
}

void GpuBundleLists::take_slots(std::uint32_t lines, const SlotSettings& settings,
                                std::uint32_t pass) {
  opengl::Program& program = compute_program(*context_, "take_slots");
  program.storage(2, counts_);
  program.storage(3, starts_);
  program.storage(4, words_);
  program.storage(8, slots_);
  program.storage(9, first_words_);
  program.set("line_count", lines);
  program.storage(10, faults_);
  program.set("slot_count", static_cast<std::uint32_t>(settings.slots));
  program.set("pass", pass);
  program.set("until_complete", settings.until_complete ? 1 : 0);
  dispatch_items(program, lines);
}

void GpuBundleLists::order(const BundleFrame& frame, const LineRows& rows, bool is_counted) {
  opengl::Program& program = compute_program(*context_, "order_lines");
  program.storage(0, triangles_);
  program.storage(1, planes_);
  program.storage(2, counts_);
  program.storage(3, starts_);
  program.storage(4, words_);
  program.storage(5, nodes_);
  program.storage(6, cells_);
  program.storage(7, texels_);
  program.storage(8, faults_);
  program.set("is_counted", is_counted ? 1 : 0);
  program.set("line_count", static_cast<std::uint32_t>(line_count(frame, rows)));
  program.set("width_px", frame.width_px);
  program.set("first_row", rows.begin);
  program.set("atlas_side_px", atlas_side_px_);
  program.set("tie_m", tie_distance_m(frame));
  set_loop_probe(program);
  program.set("edge_margin_px", tracer_ ? 0.0F : kEdgeMargin_px);
  dispatch_items(program, static_cast<std::int64_t>(line_count(frame, rows)));
  const std::vector<std::uint32_t> found = faults_.read<std::uint32_t>(2);
  const std::uint32_t faults = found[0];
  const std::uint32_t unordered = found[1];
  if (unordered > 0) {
    throw UnsupportedError(fmt::format(
        "ray-bundles: {} ends loops before the crossings of {} of {} lines are in order; accepted: "
        "backend cpu, or a scene of fewer surfaces behind each other",
        context_->facts().renderer, unordered, line_count(frame, rows)));
  }
  if (faults == 0) return;
  throw base::DeviceError(fmt::format(
      "ray-bundles: {} counts and fills {} of {} lines differently; accepted: backend cpu",
      context_->facts().renderer, faults, line_count(frame, rows)));
}

/// Appends the rows' lists, without what duplicates left free, to the bands.
void GpuBundleLists::copy(const BundleFrame& frame, const LineRows& rows,
                          BundleLists& lists) const {
  const std::size_t lines = line_count(frame, rows);
  const std::vector<ListNode> nodes = nodes_.read<ListNode>(crossings_);
  const std::vector<std::uint32_t> starts = starts_.read<std::uint32_t>(lines);
  const std::vector<std::uint32_t> counts = counts_.read<std::uint32_t>(lines);
  const auto copy_row = [&](int row) {
    BundleLists::Band& band = lists.band(static_cast<std::size_t>(row / BundleLists::kBandRows));
    const std::size_t first =
        static_cast<std::size_t>(row - rows.begin) * static_cast<std::size_t>(frame.width_px);
    for (std::size_t line = first; line < first + static_cast<std::size_t>(frame.width_px);
         ++line) {
      const auto begin = nodes.begin() + static_cast<std::ptrdiff_t>(starts[line]);
      band.nodes.insert(band.nodes.end(), begin, begin + counts[line]);
      band.ends.push_back(static_cast<std::uint32_t>(band.nodes.size()));
    }
  };
  const auto first_band = static_cast<std::size_t>(rows.begin / BundleLists::kBandRows);
  const auto last_band = static_cast<std::size_t>((rows.end - 1) / BundleLists::kBandRows);
  base::parallel_for(last_band - first_band + 1, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = first_band + begin; band < first_band + end; ++band) {
      const int band_row = static_cast<int>(band) * BundleLists::kBandRows;
      const int row_end = std::min(rows.end, band_row + BundleLists::kBandRows);
      for (int row = std::max(rows.begin, band_row); row < row_end; ++row) copy_row(row);
    }
  });
}

SlotCounts GpuBundleLists::keep(const BundleFrame& frame, const SlotSettings* slots,
                                StageTimer& timer) {
  assert(!tracer_ || slots == nullptr);
  const LineRows all{0, frame.height_px};
  const std::size_t line_words = slots != nullptr ? static_cast<std::size_t>(slots->slots) : 1;
  require_block("slots of the lines", line_count(frame, all) * line_words, kWordBytes);
  std::optional<SlotCounts> counts;
  {
    const opengl::GpuStage stage(*context_, timer, finding_stage());
    begin_frame(frame);
    counts = slots != nullptr ? draw_slots(frame, *slots, all) : draw_counted(frame, all);
  }
  if (!counts) {
    throw UnsupportedError(fmt::format(
        "ray-bundles: the crossings of {} lines do not fit a storage block of {}, {} bytes; "
        "accepted: exchange cpu, or fewer lines",
        line_count(frame, all), context_->facts().renderer, most_block_bytes_));
  }
  const opengl::GpuStage stage(*context_, timer, "order");
  order(frame, all, slots == nullptr);
  context_->check("making the lists of a bundle");
  return *counts;
}

std::int64_t GpuBundleLists::memory_bytes() const {
  std::size_t bytes = tracer_ ? static_cast<std::size_t>(tracer_->memory_bytes()) : 0;
  for (const opengl::Buffer* buffer : {&triangles_, &cells_, &texels_, &planes_, &counts_, &starts_,
                                       &words_, &nodes_, &slots_, &first_words_}) {
    bytes += buffer->size_bytes();
  }
  return static_cast<std::int64_t>(bytes);
}

}  // namespace renderers::ray_bundles

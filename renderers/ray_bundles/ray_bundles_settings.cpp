#include "renderers/ray_bundles/ray_bundles_settings.h"

#include <array>
#include <bit>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include "perception/base/errors.h"
#include "renderers/contract/choice_names.h"

namespace renderers::ray_bundles {

namespace {

using base::choice_parameter;
using base::integer_parameter;
using base::ParameterSpec;
using base::real_parameter;

template <typename Value, std::size_t count>
using Names = std::array<std::pair<const char*, Value>, count>;

constexpr Names<Backend, 3> kBackends{
    {{"auto", Backend::automatic}, {"cpu", Backend::cpu}, {"opengl", Backend::opengl}}};
constexpr Names<ExchangePlace, 3> kExchanges{{{"auto", ExchangePlace::automatic},
                                              {"cpu", ExchangePlace::cpu},
                                              {"device", ExchangePlace::device}}};
constexpr Names<DirectionKind, 5> kDirections{{{"halton", DirectionKind::halton},
                                               {"halton_permuted", DirectionKind::halton_permuted},
                                               {"hammersley", DirectionKind::hammersley},
                                               {"fibonacci", DirectionKind::fibonacci},
                                               {"iid", DirectionKind::iid}}};
constexpr Names<ListKind, 3> kLists{
    {{"raster", ListKind::raster}, {"fixed_k", ListKind::fixed_k}, {"trace", ListKind::trace}}};
constexpr Names<TransferMode, 2> kTransfers{
    {{"gather", TransferMode::gather}, {"scatter", TransferMode::scatter}}};
constexpr Names<Normalisation, 2> kNormalisations{
    {{"self", Normalisation::self}, {"uniform", Normalisation::uniform}}};
constexpr Names<FeedKind, 4> kFeeds{{{"growing_step", FeedKind::growing_step},
                                     {"running_mean", FeedKind::running_mean},
                                     {"jacobi", FeedKind::jacobi},
                                     {"stochastic", FeedKind::stochastic}}};
constexpr Names<DirectMode, 3> kDirects{{{"bundles", DirectMode::bundles},
                                         {"pcss", DirectMode::pcss},
                                         {"next_event", DirectMode::next_event}}};
constexpr Names<LightPaths, 2> kPaths{{{"all", LightPaths::all}, {"direct", LightPaths::direct}}};
constexpr Names<GlossyPaths, 2> kGlossyPaths{
    {{"last_surface", GlossyPaths::last_surface}, {"chain", GlossyPaths::chain}}};
constexpr Names<FinalGlossy, 2> kFinalGlossy{
    {{"ray", FinalGlossy::ray}, {"bundles", FinalGlossy::bundles}}};
constexpr Names<texel_atlas::ChartKind, 2> kCharts{
    {{"connected", texel_atlas::ChartKind::connected},
     {"triangle", texel_atlas::ChartKind::triangle}}};

constexpr double kMostDirections = 1 << 24;

std::vector<ParameterSpec> bundle_parameters() {
  return {
      integer_parameter("samples", 1024, {1.0, kMostDirections}, "directions",
                        "Bundles, each of which carries light both ways; the paper shows previews "
                        "at 200 and pictures of 300 to 4000."),
      choice_parameter("backend", names_of(kBackends), "auto",
                       "What finds the crossings; auto: a graphics device, but the CPU where "
                       "OpenGL is software, which is slower, or, with a note, where the device's "
                       "storage blocks do not hold the scene."),
      choice_parameter(
          "exchange", names_of(kExchanges), "auto",
          "backend opengl: where light goes from sender to receiver; device: lists "
          "and light stay there, for transfer scatter, feeds growing_step and "
          "running_mean, without census, lobes lit by bundles or textures point; auto: "
          "there if it can and is hardware; cpu: lists are read back."),
      integer_parameter(
          "lines", 384, {4.0, 8192.0}, "lines",
          "Lines of a bundle across the scene's bounding sphere; the paper's k-buffer "
          "has 512 to 2048; the default is ours."),
      choice_parameter("directions", names_of(kDirections), "halton_permuted",
                       "Halton and Hammersley points as in Sec. 4.3, or ours: shuffled in blocks "
                       "that end at powers of two and multiples of 1024, Fibonacci, independent."),
      integer_parameter("set_size", 0, {0.0, kMostDirections}, "directions",
                        "hammersley, fibonacci: of a complete set, whose beginning is used where "
                        "fewer are asked for; 0: as many as asked for."),
      real_parameter("importance", 0.0, {0.0, 0.95}, "",
                     "Share of the directions drawn by the light that bundles have to carry, and "
                     "weighted (left to the future in Sec. 7); ours."),
      choice_parameter("lists", names_of(kLists), "raster",
                       "How crossings are found: raster: by drawing triangles, fragments counted "
                       "first; fixed_k: into the slots of a k-buffer (Sec. 4.2); trace: by rays "
                       "that go on behind every hit, Embree's or, with OpenGL, in compute "
                       "shaders; ours."),
      integer_parameter("slots", 8, {1.0, 254.0}, "slots",
                        "fixed_k: fragments that a line holds; Table 1 has 8 and 16, the stencil's "
                        "limit is 254."),
      choice_parameter("slot_passes", {"until_complete", "one"}, "until_complete",
                       "fixed_k: draws again until no fragment is left (Sec. 4.2), or once, and "
                       "counts what is dropped."),
      choice_parameter("transfer", names_of(kTransfers), "scatter",
                       "gather: each texel looks for itself in a list (Sec. 4.2); scatter: each "
                       "pair of neighbours exchanges radiance, ours."),
      choice_parameter("textures", {"point", "texel"}, "point",
                       "Emission and albedo of what lines meet: at the point itself, or the means "
                       "of its texel; the camera always sees the point."),
      choice_parameter("normalisation", names_of(kNormalisations), "self",
                       "self: by the weights a texel got, ours; uniform: 2 pi / N (Eq. 3)."),
  };
}

std::vector<ParameterSpec> bounce_parameters() {
  return {
      choice_parameter("feed", names_of(kFeeds), "growing_step",
                       "What senders reflect: growing_step forgets the dark start, ours; "
                       "running_mean (Sec. 5.5) never does; jacobi: bounce by bounce (Sec. 5.2); "
                       "stochastic: the last direction's light (Szirmay-Kalos 1999)."),
      real_parameter("feed_step", 8.0, {1.0, 1000.0}, "",
                     "growing_step: k of the step k / (i + k); at least 1 / (1 - albedo); ours."),
      integer_parameter("direct_only", 0, {0.0, kMostDirections}, "directions",
                        "At the beginning, directions that carry light from its sources alone; the "
                        "paper's Fig. 10 has 8."),
      integer_parameter("census", 0, {0.0, 64.0}, "reflections",
                        "Light that was reflected up to so often is counted apart (Fig. 7), at the "
                        "cost of as many more exchanges; 0: not at all; ours."),
      integer_parameter("bounces", 6, {1.0, 1024.0}, "bounces",
                        "jacobi: interreflections, each with an equal share of the directions."),
  };
}

std::vector<ParameterSpec> glossy_parameters() {
  return {
      choice_parameter(
          "glossy", names_of(kGlossyPaths), "last_surface",
          "Lobes act at the surface the camera sees (claims diffuse), or chain: at all "
          "surfaces, by the transfer atlas of Sec. 5.4 (claims full); noise of a chain "
          "is unbounded where most surfaces are glossy: n >= 6 at rho_s 0.5."),
      choice_parameter(
          "final_glossy", names_of(kFinalGlossy), "ray",
          "Light of the lobe that the camera sees: by a ray into the atlas, ours, with "
          "bundles for what other lobes send; or bundles: for all of it (Sec. 5.3)."),
      real_parameter("most_exponent", 200.0, {1.0, 1e5}, "",
                     "Greatest exponent of lobes that bundles may light; sharper ones fall between "
                     "directions (Sec. 6.6) and are refused; of GGX, 1 / (2 alpha^2) - 2; ours."),
  };
}

std::vector<ParameterSpec> light_parameters() {
  return {
      choice_parameter("direct", names_of(kDirects), "next_event",
                       "Direct light by bundles (Sec. 5.1), or, with the bundles for the rest "
                       "(Sec. 6.5), by percentage-closer soft shadows as in Fig. 11 or by samples "
                       "on the lights, ours; point and spot lights by shadow rays."),
      choice_parameter("paths", names_of(kPaths), "all",
                       "direct: bundles carry the light of its sources alone (the direct rows of "
                       "Table 1)."),
      choice_parameter("part", {"all", "indirect"}, "all",
                       "indirect: without emission seen by the camera and light that meets one "
                       "surface."),
      integer_parameter("light_samples", 4, {1.0, 4096.0}, "samples",
                        "next_event: samples of area lights and environment per texel; ours."),
      integer_parameter("map_px", 1024, {16.0, 8192.0}, "texels",
                        "pcss: along a side of each light's shadow map; ours."),
      base::boolean_parameter("receiver_plane", true,
                              "pcss: what lies behind a point's tangent plane hides nothing, ours; "
                              "without it whatever is nearer to the light does."),
      integer_parameter("light_points", 64, {4.0, 256.0}, "points",
                        "pcss: of each light, for its unoccluded light and its width; a power of "
                        "two; ours."),
      integer_parameter("camera_rays", 4, {1.0, 4096.0}, "rays per pixel",
                        "Rays of a pass through the pixels, each with one light sample under "
                        "next_event; ours."),
      integer_parameter("pass_directions", 32, {1.0, kMostDirections}, "directions",
                        "Directions for each pass of camera_rays, so that pixels converge as the "
                        "atlas does; ours."),
  };
}

std::vector<ParameterSpec> atlas_parameters() {
  return {
      integer_parameter("atlas_side", 512, {8.0, 8192.0}, "texels",
                        "Side of the square atlas; the paper's timings have 2048."),
      real_parameter("atlas_density", 0.0, {0.0, 1e6}, "texels/m",
                     "Least density of texels; 0: the greatest that fits; ours."),
      choice_parameter(
          "charts", names_of(kCharts), "connected",
          "Triangles that meet and face nearly the same way share a chart, or each has "
          "its own; ours."),
      integer_parameter("padding", 2, {0.0, 64.0}, "texels", "Between charts; ours."),
      choice_parameter("sides", {"both", "front"}, "both",
                       "Sides of surfaces that reflect; materials here do on both."),
  };
}

TransportSettings transport_of(const base::Parameters& parameters) {
  const auto text = [&](const char* name) -> const std::string& { return parameters.text(name); };
  TransportSettings transport;
  transport.lines_across = static_cast<int>(parameters.integer("lines"));
  transport.directions = value_of(kDirections, text("directions"));
  transport.set_size = parameters.integer("set_size");
  transport.census = static_cast<int>(parameters.integer("census"));
  transport.importance = parameters.real("importance");
  transport.lists = value_of(kLists, text("lists"));
  transport.slots.slots = static_cast<int>(parameters.integer("slots"));
  transport.slots.until_complete = text("slot_passes") == "until_complete";
  transport.exchange = value_of(kExchanges, text("exchange"));
  transport.mode = value_of(kTransfers, text("transfer"));
  transport.textures_at_points = text("textures") == "point";
  SolutionSettings& solution = transport.solution;
  solution.normalisation = value_of(kNormalisations, text("normalisation"));
  solution.feed = value_of(kFeeds, text("feed"));
  solution.step_k = parameters.real("feed_step");
  // Bounce by bounce, the first share of the directions carries direct light alone as it is.
  if (solution.feed != FeedKind::jacobi) solution.direct_only = parameters.integer("direct_only");
  solution.has_back_sides = text("sides") == "both";
  return transport;
}

/// @throws InputError for what cannot be together
void check_combinations(const Settings& settings) {
  const bool can_exchange =
      can_exchange_on_device(settings.transport) && !has_glossy_bundles(settings);
  if (settings.transport.exchange == ExchangePlace::device &&
      (!can_exchange || settings.backend == Backend::cpu)) {
    throw base::InputError(
        "ray-bundles: exchange device; accepted with it: backend opengl, transfer scatter, "
        "feed growing_step or running_mean, census 0, glossy last_surface, final_glossy ray; or "
        "exchange cpu");
  }
  const bool is_chain = settings.glossy == GlossyPaths::chain;
  const bool is_jacobi = settings.transport.solution.feed == FeedKind::jacobi;
  if (!std::has_single_bit(static_cast<unsigned>(settings.soft.light_points))) {
    throw base::InputError("ray-bundles: light_points is " +
                           std::to_string(settings.soft.light_points) +
                           "; accepted: a power of two from 4 to 256");
  }
  if (is_chain && is_jacobi) {
    throw base::InputError(
        "ray-bundles: glossy chain with feed jacobi; what lobes send belongs to no bounce: take "
        "another feed, or glossy last_surface");
  }
  if (settings.transport.census > 0 && (is_chain || is_jacobi)) {
    throw base::InputError(
        "ray-bundles: census with glossy chain or feed jacobi; accepted: glossy last_surface and "
        "another feed");
  }
  if (settings.paths != LightPaths::direct) return;
  if (settings.part == Part::indirect || is_jacobi) {
    throw base::InputError(
        "ray-bundles: paths direct with part indirect or feed jacobi leaves no light; accepted: "
        "part all and another feed");
  }
}

}  // namespace

std::vector<ParameterSpec> parameter_specs() {
  std::vector<ParameterSpec> specs;
  for (auto group : {bundle_parameters(), bounce_parameters(), glossy_parameters(),
                     light_parameters(), atlas_parameters()}) {
    specs.insert(specs.end(), std::make_move_iterator(group.begin()),
                 std::make_move_iterator(group.end()));
  }
  return specs;
}

std::vector<base::Preset> presets() {
  using Value = base::ParameterValue;
  // Sec. 4.1: texels hold emission and reflectance; Sec. 4.2 and 4.3: a k-buffer of 8 slots, gather
  // by texels, raw Halton points; Sec. 5.1: emitters met by bundles; Sec. 5.3 and 5.4: lobes lit by
  // bundles, a second atlas for what they send on; Sec. 5.5: interleaved transfer, a mean from the
  // start; Sec. 6.4: eight directions of direct light first, 2000 in all, 1024 x 1024 lines, 2048 x
  // 2048 texels.
  base::Preset paper{"paper",
                     {{"samples", Value(std::int64_t{2000})},
                      {"lines", Value(std::int64_t{1024})},
                      {"directions", Value(std::string("halton"))},
                      {"lists", Value(std::string("fixed_k"))},
                      {"transfer", Value(std::string("gather"))},
                      {"textures", Value(std::string("texel"))},
                      {"normalisation", Value(std::string("uniform"))},
                      {"feed", Value(std::string("running_mean"))},
                      {"direct_only", Value(std::int64_t{8})},
                      {"glossy", Value(std::string("chain"))},
                      {"final_glossy", Value(std::string("bundles"))},
                      {"direct", Value(std::string("bundles"))},
                      {"receiver_plane", Value(false)},
                      {"atlas_side", Value(std::int64_t{2048})}}};
  return {std::move(paper), base::Preset{"best", {}}};
}

Settings settings_of(const base::Parameters& parameters) {
  const auto integer = [&](const char* name) { return static_cast<int>(parameters.integer(name)); };
  const auto text = [&](const char* name) -> const std::string& { return parameters.text(name); };
  Settings settings;
  settings.samples = parameters.integer("samples");
  settings.backend = value_of(kBackends, text("backend"));
  settings.part = part_from_text(text("part"));
  settings.paths = value_of(kPaths, text("paths"));
  settings.direct = value_of(kDirects, text("direct"));
  settings.bounces = parameters.integer("bounces");
  settings.light_samples = integer("light_samples");
  settings.soft.shadows.map_px = integer("map_px");
  settings.soft.shadows.has_receiver_plane = parameters.boolean("receiver_plane");
  settings.soft.light_points = integer("light_points");
  settings.camera_rays = integer("camera_rays");
  settings.pass_directions = parameters.integer("pass_directions");
  settings.glossy = value_of(kGlossyPaths, text("glossy"));
  settings.final_glossy = value_of(kFinalGlossy, text("final_glossy"));
  settings.most_exponent = parameters.real("most_exponent");
  settings.atlas.side_px = integer("atlas_side");
  settings.atlas.texels_per_m = parameters.real("atlas_density");
  settings.atlas.padding_px = integer("padding");
  settings.atlas.charts.kind = value_of(kCharts, text("charts"));
  settings.transport = transport_of(parameters);
  SolutionSettings& solution = settings.transport.solution;
  solution.glossy_chain = settings.glossy == GlossyPaths::chain;
  solution.carries_emission = settings.direct == DirectMode::bundles;
  check_combinations(settings);
  // What the camera sees of lobes looks at the lists.
  if (has_glossy_bundles(settings)) settings.transport.exchange = ExchangePlace::cpu;
  if (settings.paths == LightPaths::direct) {
    solution.direct_only = std::numeric_limits<std::int64_t>::max();
  }
  return settings;
}

Claims claims_of(const base::Parameters& parameters) {
  if (value_of(kPaths, parameters.text("paths")) == LightPaths::direct) {
    return {Transport::direct, Part::all, std::nullopt};
  }
  const bool is_full = parameters.text("glossy") == "chain";
  return {is_full ? Transport::full : Transport::diffuse, part_from_text(parameters.text("part")),
          std::nullopt};
}

}  // namespace renderers::ray_bundles

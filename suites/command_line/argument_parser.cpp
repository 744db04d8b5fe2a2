#include "suites/command_line/argument_parser.h"

#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "perception/base/errors.h"
#include "suites/command_line/device_probe.h"
#include "suites/command_line/known_words.h"
#include "suites/command_line/option_values.h"

namespace suites::command_line {

namespace {

constexpr const char* kWithoutSuite = "Without a suite";
constexpr const char* kRepeatable = " (repeatable)";
/// One verb: its parser and, once parsed, its arguments.
struct Verb {
  CLI::App* app = nullptr;
  std::function<VerbArguments()> arguments;
};

struct Verbs {
  CLI::App& app;
  std::vector<Verb> list;
};

/// Adds a verb, with --json if its arguments know it; the arguments live as long as the verb.
template <typename Arguments>
std::pair<CLI::App*, Arguments*> add_verb(Verbs& verbs, const std::string& name,
                                          const std::string& doc) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* app = verbs.app.add_subcommand(name, doc);
  if constexpr (requires { arguments->json; }) {
    app->add_flag("--json", arguments->json, "print one JSON object on stdout, also on failure");
  }
  verbs.list.push_back({app, [arguments] { return *arguments; }});
  return {app, arguments.get()};
}

/// An option with one whole number >= low; the target is an integer or an optional of one.
template <typename Target>
CLI::Option* add_integer(CLI::App& app, const std::string& name, Target& target, std::int64_t low,
                         const std::string& doc) {
  const auto store = [&target, name, low](const std::string& text) {
    const std::int64_t value = parse_integer_option(text, name, low);
    if constexpr (std::is_integral_v<Target>) target = static_cast<Target>(value);
    if constexpr (!std::is_integral_v<Target>) target = value;
  };
  return app.add_option_function<std::string>(name, store, doc)->type_name("N");
}

CLI::Option* add_number(CLI::App& app, const std::string& name, std::optional<double>& target,
                        const std::string& doc) {
  const auto store = [&target, name](const std::string& text) {
    target = parse_number_option(text, name);
  };
  return app.add_option_function<std::string>(name, store, doc)->type_name("NUMBER");
}

/// A text option that takes one word each time and may be given often.
CLI::Option* add_list(CLI::App& app, const std::string& name, std::vector<std::string>& target,
                      const std::string& doc) {
  return app.add_option(name, target, doc + kRepeatable)->allow_extra_args(false);
}

void add_results(CLI::App& app, std::string& target) {
  app.add_option("--results", target,
                 "results folder (default: $DISCERN_RESULTS, else results/ of the checkout)")
      ->type_name("DIR");
}

void add_threads(CLI::App& app, int& target) {
  add_integer(app, "--threads", target, 1, "threads (default: one per core)");
}

void add_device(CLI::App& app, std::string& target) {
  const std::vector<std::string> known = known_devices();
  const auto store = [&target, known](const std::string& word) {
    require_known(word, known, "--device", "device");
    target = word;
  };
  const std::string doc = fmt::format("where OpenGL renderers run: {}", fmt::join(known, ", "));
  app.add_option_function<std::string>("--device", store, doc);
}

void add_selection(CLI::App& app, SuiteSelection& selection) {
  app.add_option("suite", selection.suite, "suite file or catalogue name")->type_name("SUITE");
  app.add_option("--profile", selection.profile, "sizes and counts of this profile");
  app.add_option("--filter", selection.filter, "only cells whose scene, method or name match")
      ->type_name("REGEX");
}

void add_counts(CLI::App& app, SuiteSelection& selection) {
  add_integer(app, "--seeds", selection.seeds, 1, "number of seeds instead of the suite's");
  add_integer(app, "--repetitions", selection.repetitions, 1,
              "repetitions of every cell instead of the suite's");
}

/// Puts options under a heading of the help.
void put_under(const char* heading, std::initializer_list<CLI::Option*> options) {
  for (CLI::Option* option : options) option->group(heading);
}

CLI::Option* add_size(CLI::App& app, std::string& size) {
  return app.add_option("--size", size, "image size (default: 256x256)")->type_name("WxH");
}

void add_ad_hoc(CLI::App& app, SuiteSelection& s) {
  put_under(kWithoutSuite,
            {add_list(app, "--scene", s.scenes, "scene file or catalogue name"),
             add_list(app, "--method", s.methods, "RENDERER[,preset=P][,parameter=value]..."),
             add_size(app, s.size), add_list(app, "--samples", s.samples, "budget in samples"),
             add_list(app, "--time", s.times, "budget in time, such as 10s"),
             add_list(app, "--metric", s.metrics, "NAME[,parameter=value]..."),
             add_integer(app, "--reference-samples", s.reference_samples, 1,
                         "samples per pixel of the references")});
}

void add_list_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<ListArguments>(verbs, "list", "what there is to render, to score and to run on");
  verb->add_option("kind", a->kind, "renderers | metrics | scenes | suites | devices")->required();
  verb->add_option("--filter", a->filter, "only names that match")->type_name("REGEX");
}

void add_check_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<CheckArguments>(verbs, "check", "read a suite and print its plan, run nothing");
  add_selection(*verb, a->selection);
  add_counts(*verb, a->selection);
  add_ad_hoc(*verb, a->selection);
  add_results(*verb, a->results);
}

void add_run_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<RunArguments>(verbs, "run", "run a suite, or scenes x methods; resumes");
  add_selection(*verb, a->selection);
  add_counts(*verb, a->selection);
  add_ad_hoc(*verb, a->selection);
  add_threads(*verb, a->threads);
  add_device(*verb, a->device);
  add_results(*verb, a->results);
  verb->add_flag("--force", a->force, "start a new run instead of resuming");
  verb->add_flag("--dry-run", a->dry_run, "print the plan, run nothing");
  verb->add_option("--junit", a->junit, "also write junit.xml here")->type_name("FILE");
  verb->add_flag("--strict", a->strict, "exit 5 if a gate is inconclusive or not measured");
}

void add_render_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<RenderArguments>(verbs, "render", "render and time one image");
  verb->add_option("--scene", a->scene, "scene file or catalogue name")->required();
  verb->add_option("--renderer", a->renderer, "renderer's name")->required();
  verb->add_option("--preset", a->preset, "preset of the renderer")->capture_default_str();
  add_list(*verb, "--set", a->settings, "parameter=value");
  verb->add_option("--size", a->size, "image size")->type_name("WxH")->required();
  add_integer(*verb, "--seed", a->seed, 0, "random seed (default: 1)");
  add_integer(*verb, "--samples", a->samples, 1,
              "progressive units to do (list renderers names the unit)");
  verb->add_option("--time", a->time, "time budget, such as 10s");
  add_integer(*verb, "--frame", a->frame, 0, "frame of an animated scene (default: 0)");
  add_threads(*verb, a->threads);
  add_device(*verb, a->device);
  verb->add_option("--crop", a->crop, "keep this part of the image")->type_name("X,Y,W,H");
  verb->add_option("--aov", a->aov, "write this AOV only (default: the image; EXR: all)");
  add_number(*verb, "--exposure", a->exposure_ev, "stops applied to a PNG (default: 0)");
  verb->add_option("--out", a->out, "image file, .exr or .png")->required();
}

void add_viewing(CLI::App& app, ViewingArguments& a) {
  add_number(app, "--ppd", a.pixels_per_degree, "pixels per degree of visual angle");
  app.add_option("--display", a.display, "viewing preset: display and distance");
  add_number(app, "--exposure", a.exposure_ev, "stops applied before display (default: 0)");
  add_number(app, "--luminance-scale", a.luminance_scale_cd_m2,
             "cd/m2 of scene-linear 1.0 (default: the file's, else 100)");
  app.add_option("--encoding", a.encoding, "scene_linear | luminance_cd_m2 | display");
}

void add_diff_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<DiffArguments>(verbs, "diff", "score images against a reference");
  verb->add_option("reference", a->reference, "reference image")->required();
  verb->add_option("test", a->tests, "images to score")->required();
  verb->add_option("--frames", a->frames,
                   "FIRST..LAST[xSTEP]: score sequences, whose names hold %04d or ####")
      ->type_name("FRAMES");
  add_list(*verb, "--metric", a->metrics,
           "NAME[,parameter=value]... (default: flip, relmse, ssim, of sequences flicker, too)");
  add_viewing(*verb, a->viewing);
  verb->add_option("--region", a->region, "score this part only")->type_name("X,Y,W,H");
  verb->add_option("--mask", a->mask, "image of 0 and 1: score where it is 1");
  verb->add_option("--map-dir", a->map_folder, "write error maps, EXR and PNG")->type_name("DIR");
  verb->add_flag("--ignore-non-finite", a->ignore_non_finite, "score the finite pixels only");
  add_list(*verb, "--fail-above", a->fail_above, "METRIC[.DETAIL]=V: exit 1 if it is above V");
  add_list(*verb, "--fail-below", a->fail_below, "METRIC[.DETAIL]=V: exit 1 if it is below V");
  verb->add_option("--at", a->at, "print the values of this pixel")->type_name("X,Y");
  add_threads(*verb, a->threads);
}

void add_thresholds_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<ThresholdsArguments>(
      verbs, "thresholds", "maps of the least visible change of every pixel");
  verb->add_option("image", a->image, "image that is looked at")->required();
  add_viewing(*verb, a->viewing);
  verb->add_option("--masking", a->profile,
                   "rama99_calibrated | rama99 | yee_compat (default: rama99_calibrated)");
  verb->add_option("--csf", a->csf, "contrast sensitivity (default: the masking's)");
  verb->add_option("--tvi", a->curve, "threshold against luminance (default: ward)");
  verb->add_option("--out", a->out, "folder for the maps, EXR and PNG")
      ->type_name("DIR")
      ->required();
  add_threads(*verb, a->threads);
}

void add_ref_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<RefArguments>(verbs, "ref", "reference images: make, extend, verify, list");
  verb->add_option("action", a->action, "build | extend | verify | info")->required();
  add_selection(*verb, a->selection);
  put_under(kWithoutSuite,
            {add_list(*verb, "--scene", a->selection.scenes, "scene file or catalogue name"),
             add_size(*verb, a->selection.size),
             verb->add_option("--transport", a->transport,
                              "direct | one_bounce | diffuse | full (default: full)"),
             add_number(*verb, "--geometry-clamp", a->geometry_clamp, "1/m2 (default: none)"),
             add_integer(*verb, "--frame", a->frame, 0, "frame of the scene (default: 0)")});
  add_integer(*verb, "--samples", a->samples, 1, "samples per pixel; for extend: to add");
  add_threads(*verb, a->threads);
  add_device(*verb, a->device);
  add_results(*verb, a->results);
}

void add_report_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<ReportArguments>(verbs, "report", "write the report of a run, also a running one");
  verb->add_option("run", a->run, "run folder, id, suite name or \"last\"")->required();
  add_results(*verb, a->results);
}

void add_eval_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<EvalArguments>(verbs, "eval", "score the stored images of a run again");
  verb->add_option("run", a->run, "run folder, id, suite name or \"last\"")->required();
  add_list(*verb, "--metric", a->metrics, "NAME[,parameter=value]... (default: the suite's)");
  verb->add_option("--filter", a->filter, "only cells that match")->type_name("REGEX");
  add_threads(*verb, a->threads);
  add_results(*verb, a->results);
}

void add_claims_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<ClaimsArguments>(verbs, "claims", "what a run says of the claims of its suite");
  verb->add_option("suite", a->suite, "suite file or catalogue name")->required();
  verb->add_option("--run", a->run, "run folder, id or \"last\" (default: the suite's newest)");
  verb->add_flag("--strict", a->strict,
                 "exit 1 if a claim is not reproduced, 5 if one is inconclusive");
  add_results(*verb, a->results);
}

/// A share between 0 and 1, or a percentage.
void add_share(CLI::App& app, const std::string& name, std::optional<double>& target,
               const std::string& doc) {
  const auto store = [&target, name](const std::string& text) {
    target = parse_share_option(text, name);
  };
  app.add_option_function<std::string>(name, store, doc)->type_name("SHARE");
}

void add_accept_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<AcceptArguments>(
      verbs, "accept", "make a run the baseline that later ones are compared with");
  verb->add_option("run", a->run, "run folder, id, suite name or \"last\"")->required();
  verb->add_option("--reason", a->reason, "why; kept with the baseline")->required();
  verb->add_option("--author", a->author, "who (default: the user's name)");
  verb->add_option("--filter", a->filter, "only rows whose scene, method or cell match")
      ->type_name("REGEX");
  add_results(*verb, a->results);
}

void add_compare_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<CompareArguments>(
      verbs, "compare", "what changed between two runs of a suite, beyond their noise");
  verb->add_option("before", a->before,
                   "earlier run: folder, id, suite name, \"last\" or \"baseline\"")
      ->required();
  verb->add_option("after", a->after, "later run")->required();
  add_share(*verb, "--alpha", a->alpha, "false alarms among changes (default: 1%)");
  add_share(*verb, "--time-effect", a->time_effect,
            "least change of a time that counts (default: 5%)");
  add_share(*verb, "--score-effect", a->score_effect,
            "least change of a score that counts (default: 5%)");
  verb->add_flag("--gates", a->gates, "judge by the gates of the later run's suite alone");
  verb->add_flag("--canary", a->by_canary,
                 "divide later times by how much longer the canary took, row by row");
  verb->add_flag("--only-changed", a->only_changed, "print better, worse and invalid rows alone");
  verb->add_flag("--strict", a->strict, "exit 5 if a row is inconclusive");
  add_results(*verb, a->results);
}

void add_figure_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<FigureArguments>(verbs, "figure", "draw the figures of a suite");
  verb->add_option("suite", a->suite, "suite file or catalogue name")->required();
  verb->add_option("id", a->id, "this figure only");
  verb->add_option("--run", a->run, "run folder, id or \"last\" (default: the suite's newest)");
  verb->add_option("--out", a->out, "folder (default: figures/ of the run)")->type_name("DIR");
  add_list(*verb, "--format", a->formats, "pdf | svg (default: both)");
  add_results(*verb, a->results);
}

void add_table_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<TableArguments>(verbs, "table", "a run's numbers as text, Markdown, CSV or LaTeX");
  verb->add_option("run", a->run, "run folder, id, suite name or \"last\"")->required();
  const auto store = [arguments = a](const std::string& word) {
    require_known(word, {"text", "markdown", "csv", "latex"}, "--format", "format");
    arguments->format = word;
  };
  verb->add_option_function<std::string>("--format", store,
                                         "text | markdown | csv | latex (default: text)");
  verb->add_option("--rankings", a->rankings,
                   "only pairs of rows that two scores order differently: relmse,flip@full")
      ->type_name("A,B");
  verb->add_option("--filter", a->filter, "only rows whose scene, method or budget match")
      ->type_name("REGEX");
  add_results(*verb, a->results);
}

void add_cheapest_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<CheapestArguments>(
      verbs, "cheapest", "the least time whose error stays below a visible threshold");
  verb->add_option("run", a->run, "run folder, id, suite name or \"last\"")->required();
  verb->add_option("--metric", a->metric, "score to stay below the limit")->capture_default_str();
  verb->add_option("--below", a->below, "greatest score that counts, a number or a percentage")
      ->required();
  const auto store = [arguments = a](const std::string& word) {
    require_known(word, {"own", "full"}, "--against", "truth");
    arguments->against = word;
  };
  verb->add_option_function<std::string>("--against", store, "own | full (default: full)");
  add_results(*verb, a->results);
}

void add_history_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<HistoryArguments>(
      verbs, "history", "a quantity over all runs of a suite, and where it stepped");
  verb->add_option("suite", a->suite, "name of the suite")->required();
  verb->add_option("--quantity", a->quantity,
                   "as claims name it: total_s, gather, flip@full (default: total_s)");
  verb->add_option("--filter", a->filter, "only rows whose scene, method or budget match")
      ->type_name("REGEX");
  verb->add_option("--profile", a->profile, "default: that of the newest run");
  verb->add_option("--machine", a->machine, "default: this machine");
  add_integer(*verb, "--last", a->last, 1, "only so many of the newest runs");
  verb->add_flag("--rebuild", a->rebuild, "read all runs again, not only those that are new");
  add_results(*verb, a->results);
}

void add_merge_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<MergeArguments>(
      verbs, "merge", "make one run of several that each did a part of the same suite");
  verb->add_option("runs", a->runs, "run folders or ids, two or more")->required();
  add_results(*verb, a->results);
}

void add_doctor_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<DoctorArguments>(
      verbs, "doctor", "is this machine fit to measure on, and what would make it so");
  verb->add_flag("--strict", a->strict, "exit 5 if something would disturb times");
  add_results(*verb, a->results);
}

void add_schema_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<SchemaArguments>(verbs, "schema", "print the JSON schema of an input or an output");
  verb->add_option("name", a->name, "suite, scene, render, diff, run, ...")->required();
}

void add_probe_device_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<ProbeDeviceArguments>(verbs, "probe-device", "try a graphics platform out");
  verb->add_option("platform", a->platform, "one of list devices")->required();
  verb->group("");
}

std::vector<Verb> add_verbs(CLI::App& app) {
  Verbs verbs{app, {}};
  add_list_verb(verbs);
  add_check_verb(verbs);
  add_run_verb(verbs);
  add_render_verb(verbs);
  add_diff_verb(verbs);
  add_thresholds_verb(verbs);
  add_ref_verb(verbs);
  add_eval_verb(verbs);
  add_report_verb(verbs);
  add_claims_verb(verbs);
  add_accept_verb(verbs);
  add_compare_verb(verbs);
  add_figure_verb(verbs);
  add_table_verb(verbs);
  add_cheapest_verb(verbs);
  add_history_verb(verbs);
  add_merge_verb(verbs);
  add_doctor_verb(verbs);
  add_schema_verb(verbs);
  add_verb<WorkerArguments>(verbs, "worker", "serve repetitions to a harness").first->group("");
  add_probe_device_verb(verbs);
  return std::move(verbs.list);
}

std::vector<KnownOption> options_of(const CLI::App& verb) {
  std::vector<KnownOption> options;
  for (const CLI::Option* option : verb.get_options()) {
    const bool takes_value = option->get_expected_min() > 0;
    if (option->nonpositional()) options.push_back({option->get_name(), takes_value});
  }
  return options;
}

std::vector<std::string> verb_names(const std::vector<Verb>& verbs) {
  std::vector<std::string> names;
  for (const Verb& verb : verbs) {
    if (!verb.app->get_group().empty()) names.push_back(verb.app->get_name());
  }
  return names;
}

const Verb& find_verb(const std::vector<Verb>& verbs, const std::string& word) {
  for (const Verb& verb : verbs) {
    if (verb.app->get_name() == word) return verb;
  }
  throw base::InputError(base::unknown_name("verb", word, verb_names(verbs)));
}

}  // namespace

VerbArguments parse_arguments(const std::vector<std::string>& words) {
  CLI::App app(
      "Renders scenes with many techniques, times every stage, says how visible errors are.",
      "discern");
  app.set_help_flag("-h,--help", "print this help");
  app.get_formatter()->column_width(32);
  bool wants_version = false;
  app.add_flag("--version", wants_version, "print the version");
  const std::vector<Verb> verbs = add_verbs(app);
  const bool has_verb = !words.empty() && words.front().rfind('-', 0) != 0;
  const Verb* verb = has_verb ? &find_verb(verbs, words.front()) : nullptr;
  const std::string where = verb == nullptr ? "discern" : "discern " + words.front();
  if (verb != nullptr) refuse_unknown_options(options_of(*verb->app), words);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::CallForHelp&) {
    return TextArguments{app.help()};
  } catch (const CLI::ParseError& error) {
    throw base::InputError({where}, fmt::format("{}; see {} --help", error.what(), where));
  }
  if (wants_version) return TextArguments{"discern " DISCERN_VERSION "\n"};
  if (verb == nullptr) throw base::InputError(no_verb_message(verb_names(verbs)));
  return verb->arguments();
}

}  // namespace suites::command_line

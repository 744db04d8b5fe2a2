#include <fmt/format.h>

#include "suites/command_line/known_words.h"
#include "suites/command_line/verb_spec.h"

/// Verbs that render, score and plan, and those about the program itself.
namespace suites::command_line {

namespace {

constexpr const char* kWithoutSuite = "Without a suite";

/// Puts options under a heading of the help.
void put_under(const char* heading, std::initializer_list<OptionSpec*> options) {
  for (OptionSpec* option : options) option->group(heading);
}

OptionSpec* add_size(VerbSpec& verb, std::string& size) {
  return verb.add_option("--size", size, "image size (default: 256x256)")->type_name("WxH");
}

void add_ad_hoc(VerbSpec& verb, SuiteSelection& s) {
  put_under(
      kWithoutSuite,
      {add_list(verb, "--scene", s.scenes, "scene file or catalogue name")->type_name("SCENE"),
       add_list(verb, "--method", s.methods, "RENDERER[,preset=P][,parameter=value]...")
           ->type_name("METHOD"),
       add_size(verb, s.size), add_list(verb, "--samples", s.samples, "budget in samples"),
       add_list(verb, "--time", s.times, "budget in time, such as 10s"),
       add_list(verb, "--metric", s.metrics, "NAME[,parameter=value]...")->type_name("METRIC"),
       add_integer(verb, "--reference-samples", s.reference_samples, 1,
                   "samples per pixel of the references")});
}

void add_list_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<ListArguments>(verbs, "list", "what there is to render, to score and to run on");
  verb->add_option("kind", a->kind, "renderers | metrics | scenes | suites | devices")
      ->suggest({"renderers", "metrics", "scenes", "suites", "devices"})
      ->required();
  verb->add_option("--filter", a->filter, "only names that match")->type_name("REGEX");
  verb->add_flag("--names", a->names, "print names alone, one a line");
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
  add_integer(*verb, "--jobs", a->jobs, 1,
              "measure so many methods at once, each on cores of its own (default: 1; times are "
              "then compared with no others)");
  add_device(*verb, a->device);
  add_results(*verb, a->results);
  verb->add_flag("--force", a->force, "start a new run instead of resuming");
  verb->add_flag("--dry-run", a->dry_run, "print the plan, run nothing");
  verb->add_option("--junit", a->junit, "also write junit.xml here")->type_name("FILE");
  verb->add_flag("--strict", a->strict, "exit 5 if a gate is inconclusive or not measured");
}

void add_render_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<RenderArguments>(verbs, "render", "render and time one image");
  verb->add_option("--scene", a->scene, "scene file or catalogue name")
      ->type_name("SCENE")
      ->required();
  verb->add_option("--renderer", a->renderer, "renderer's name")->type_name("RENDERER")->required();
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
  verb->add_option("--out", a->out, "image file, .exr or .png")->type_name("FILE")->required();
}

void add_viewing(VerbSpec& verb, ViewingArguments& a) {
  add_number(verb, "--ppd", a.pixels_per_degree, "pixels per degree of visual angle");
  verb.add_option("--display", a.display, "viewing preset: display and distance");
  add_number(verb, "--exposure", a.exposure_ev, "stops applied before display (default: 0)");
  add_number(verb, "--luminance-scale", a.luminance_scale_cd_m2,
             "cd/m2 of scene-linear 1.0 (default: the file's, else 100)");
  verb.add_option("--encoding", a.encoding, "scene_linear | luminance_cd_m2 | display");
}

void add_diff_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<DiffArguments>(verbs, "diff", "score images against a reference");
  verb->add_option("reference", a->reference, "reference image")->type_name("FILE")->required();
  verb->add_option("test", a->tests, "images to score")->type_name("FILE")->required();
  verb->add_option("--frames", a->frames,
                   "FIRST..LAST[xSTEP]: score sequences, whose names hold %04d or ####")
      ->type_name("FRAMES");
  add_list(*verb, "--metric", a->metrics,
           "NAME[,parameter=value]... (default: flip, relmse, ssim, of sequences flicker, too)")
      ->type_name("METRIC");
  add_viewing(*verb, a->viewing);
  verb->add_option("--region", a->region, "score this part only")->type_name("X,Y,W,H");
  verb->add_option("--mask", a->mask, "image of 0 and 1: score where it is 1")->type_name("FILE");
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
  verb->add_option("image", a->image, "image that is looked at")->type_name("FILE")->required();
  verb->add_option("--part", a->part, "part of an EXR, an AOV of a frame (default: the first)");
  add_viewing(*verb, a->viewing);
  verb->add_option("--masking", a->profile,
                   "rama99_calibrated | rama99 | yee_compat (default: rama99_calibrated)");
  verb->add_option("--csf", a->csf, "contrast sensitivity (default: the masking's)");
  verb->add_option("--tvi", a->curve, "threshold against luminance (default: ward)");
  add_number(*verb, "--target", a->target_cpd,
             "cycles/degree: also the elevation for an artefact of this frequency");
  verb->add_option("--out", a->out, "folder for the maps, EXR and PNG")
      ->type_name("DIR")
      ->required();
  add_threads(*verb, a->threads);
}

void add_ref_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<RefArguments>(verbs, "ref", "reference images: make, extend, verify, list");
  verb->add_option("action", a->action, "build | extend | verify | info")
      ->suggest({"build", "extend", "verify", "info"})
      ->required();
  add_selection(*verb, a->selection);
  put_under(kWithoutSuite,
            {add_list(*verb, "--scene", a->selection.scenes, "scene file or catalogue name")
                 ->type_name("SCENE"),
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
  add_run(*verb, a->run);
  verb->add_flag("--split", a->split,
                 "images in files beside the page (default above 300 MB of them)");
  verb->add_flag("--one-file", a->one_file, "images inside the page, however large they are");
  add_results(*verb, a->results);
}

void add_eval_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<EvalArguments>(verbs, "eval", "score the stored images of a run again");
  add_run(*verb, a->run);
  add_list(*verb, "--metric", a->metrics, "NAME[,parameter=value]... (default: the suite's)")
      ->type_name("METRIC");
  verb->add_option("--filter", a->filter, "only cells that match")->type_name("REGEX");
  add_threads(*verb, a->threads);
  add_results(*verb, a->results);
}

void add_claims_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<ClaimsArguments>(verbs, "claims", "what a run says of the claims of its suite");
  add_suite(*verb, a->suite);
  add_run_option(*verb, a->run);
  verb->add_flag("--strict", a->strict,
                 "exit 1 if a claim is not reproduced, 5 if one is inconclusive");
  add_table_format(*verb, a->format);
  add_results(*verb, a->results);
}

void add_papers_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<PapersArguments>(
      verbs, "papers", "one page of everything that papers claim, and what was measured of it");
  verb->add_option("suites", a->suites, "suites of papers (default: those of the catalogue)")
      ->type_name("SUITE");
  verb->add_option("--profile", a->profile, "newest runs of this profile (default: newest runs)");
  verb->add_option("--out", a->out, "folder (default: papers/ of the results)")->type_name("DIR");
  add_results(*verb, a->results);
}

void add_schema_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<SchemaArguments>(verbs, "schema", "print the JSON schema of an input or an output");
  verb->add_option("name", a->name, "suite, scene, render, diff, run, ...")->required();
}

void add_completions_verb(Verbs& verbs) {
  const auto [verb, a] = add_verb<CompletionsArguments>(
      verbs, "completions", "print the script by which a shell completes what is typed");
  verb->add_option("shell", a->shell, "bash | zsh | fish")
      ->one_of({"bash", "zsh", "fish"}, "shell")
      ->required();
}

void add_probe_device_verb(Verbs& verbs) {
  const auto [verb, a] =
      add_verb<ProbeDeviceArguments>(verbs, "probe-device", "try a graphics platform out");
  verb->add_option("platform", a->platform, "one of list devices")->required();
  verb->hide();
}

}  // namespace

void add_measuring_verbs(Verbs& verbs) {
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
  add_papers_verb(verbs);
}

void add_program_verbs(Verbs& verbs) {
  add_schema_verb(verbs);
  add_completions_verb(verbs);
  add_verb<ManArguments>(verbs, "man", "print the manual page: discern man | man -l -");
  add_verb<WorkerArguments>(verbs, "worker", "serve repetitions to a harness").first->hide();
  add_probe_device_verb(verbs);
}

}  // namespace suites::command_line

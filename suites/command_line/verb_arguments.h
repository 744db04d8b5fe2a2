#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "suites/command_line/viewing_arguments.h"

/// What the command line asks for, verb by verb: plain values, names not looked up yet.
namespace suites::command_line {

/// Text to print and nothing else: --help, --version.
struct TextArguments {
  std::string text;
};

struct ListArguments {
  std::string kind;    ///< renderers | metrics | scenes | suites | devices
  std::string filter;  ///< regular expression on names; "" for all
  bool names = false;  ///< and nothing else
  bool json = false;
};

/// Which cells: a suite file, or scenes x methods x budgets of an ad-hoc suite.
struct SuiteSelection {
  std::string suite;                 ///< path or catalogue name; "" for an ad-hoc suite
  std::vector<std::string> scenes;   ///< ad hoc: paths or catalogue names
  std::vector<std::string> methods;  ///< ad hoc: renderer[,preset=P][,parameter=value]...
  std::vector<std::string> metrics;  ///< ad hoc: as `diff --metric`; empty: its default
  std::vector<std::string> samples;  ///< ad hoc: a budget each, "64"
  std::vector<std::string> times;    ///< ad hoc: a budget each, "10s"
  std::string size;                  ///< ad hoc: "256x256"
  std::optional<std::int64_t> reference_samples;  ///< ad hoc
  std::string profile;
  std::string filter;  ///< regular expression on scene, method or cell
  std::optional<std::int64_t> seeds;
  std::optional<std::int64_t> repetitions;
};

struct CheckArguments {
  SuiteSelection selection;
  std::string results;
  bool json = false;
};

struct RunArguments {
  SuiteSelection selection;
  std::string results;
  std::string device = "auto";
  int threads = 0;
  int jobs = 1;
  std::string junit;  ///< file; "": junit.xml of the run alone
  bool force = false;
  bool dry_run = false;
  bool strict = false;
  bool json = false;
  std::string command;  ///< the whole command line, for the record
};

struct RenderArguments {
  std::string scene;
  std::string renderer;
  std::string preset = "best";
  std::vector<std::string> settings;  ///< "name=value"
  std::string size;
  std::uint64_t seed = 1;
  std::optional<std::int64_t> samples;
  std::string time;  ///< "10s", "" for none
  int frame = 0;
  int threads = 0;
  std::string device = "auto";
  std::string crop;                   ///< "x,y,w,h"
  std::string aov;                    ///< "" for the image itself and, in EXR, all AOVs
  std::optional<double> exposure_ev;  ///< PNG only
  std::string out;
  bool json = false;
};

struct DiffArguments {
  std::string reference;           ///< a file; with frames a pattern of files
  std::vector<std::string> tests;  ///< likewise
  std::string frames;              ///< "0..59"; "" for single images
  std::vector<std::string> metrics;
  ViewingArguments viewing;
  std::string region;  ///< "x,y,w,h"
  std::string mask;
  std::string map_folder;
  std::vector<std::string> fail_above;  ///< "NAME=V"
  std::vector<std::string> fail_below;
  std::string at;  ///< "x,y"
  int threads = 0;
  bool ignore_non_finite = false;
  bool json = false;
};

struct ThresholdsArguments {
  std::string image;
  std::string part;  ///< "": the first
  ViewingArguments viewing;
  std::string profile = "rama99_calibrated";
  std::string csf;                   ///< "": the profile's
  std::string curve;                 ///< "": the default
  std::optional<double> target_cpd;  ///< frequency of an artefact
  std::string out;                   ///< folder
  int threads = 0;
  bool json = false;
};

struct RefArguments {
  std::string action;  ///< build | extend | verify | info
  SuiteSelection selection;
  std::string transport;  ///< "": full
  std::optional<double> geometry_clamp;
  std::optional<std::int64_t> samples;
  int frame = 0;
  int threads = 0;
  std::string device = "auto";
  std::string results;
  bool json = false;
};

struct ReportArguments {
  std::string run;
  bool split = false;     ///< images in files beside the page, however small they are
  bool one_file = false;  ///< images inside the page, however large they are
  std::string results;
  bool json = false;
};

struct EvalArguments {
  std::string run;
  std::vector<std::string> metrics;  ///< empty: the suite's
  std::string results;
  std::string filter;
  int threads = 0;
  bool json = false;
};

struct ClaimsArguments {
  std::string suite;
  std::string run;              ///< "": the newest of the suite
  std::string format = "text";  ///< one of results::kTableFormats
  std::string results;
  bool strict = false;
  bool json = false;
};

struct PapersArguments {
  std::vector<std::string> suites;  ///< none: those of the catalogue that are of papers
  std::string profile;              ///< "": the newest run of each, whatever its profile
  std::string out;                  ///< "": papers/ of the results folder
  std::string results;
  bool json = false;
};

struct AcceptArguments {
  std::string run;
  std::string reason;
  std::string author;  ///< "": the user's name
  std::string filter;  ///< regular expression on scene, method or cell
  std::string results;
  bool json = false;
};

struct CompareArguments {
  std::string before;  ///< a run, as `report` takes it, or "baseline"
  std::string after;
  std::optional<double> alpha;
  std::optional<double> time_effect;  ///< a share: 0.05 is 5 %
  std::optional<double> score_effect;
  std::string results;
  bool by_canary = false;
  bool gates = false;
  bool only_changed = false;
  bool strict = false;
  bool json = false;
};

struct FigureArguments {
  std::string suite;
  std::string id;                    ///< "": all
  std::string run;                   ///< "": the newest of the suite
  std::string out;                   ///< folder; "": figures/ of the run
  std::vector<std::string> formats;  ///< pdf, svg, png; empty: the first two
  std::string results;
  bool json = false;
};

struct ViewArguments {
  std::string run;
  std::string filter;  ///< regular expression on scene, method or budget
  std::string viewer = "127.0.0.1:14158";
  bool sends_pixels = false;  ///< the viewer cannot read the files itself
  std::string results;
  bool json = false;
};

struct TableArguments {
  std::string run;
  std::string format = "text";  ///< one of results::kTableFormats
  std::string filter;           ///< regular expression on scene, method or budget
  std::string rankings;         ///< "A,B": where two scores disagree, in place of all numbers
  std::string results;
};

struct CheapestArguments {
  std::string run;
  std::string metric = "visible-difference";
  std::string below;  ///< greatest score that counts as invisible: a number or a percentage
  std::string against = "full";
  std::string results;
  bool json = false;
};

struct HistoryArguments {
  std::string suite;
  std::string quantity;  ///< "": total_s, on a page all of them
  std::string html;      ///< file of a page; "": none
  std::string filter;    ///< regular expression on scene, method or budget
  std::string profile;   ///< "": that of the newest run
  std::string machine;   ///< "": this one
  std::optional<std::int64_t> last;
  bool rebuild = false;
  std::string results;
  bool json = false;
};

struct BisectArguments {
  std::string suite;
  std::string good;  ///< revisions as git names them
  std::string bad;
  std::string quantity;            ///< "": the suite's gates
  std::optional<double> worse_by;  ///< a share
  std::string profile;
  std::string filter;  ///< regular expression on scene, method or cell
  std::string source;  ///< git repository; "": the checkout
  std::string build = "suites/set_up core build -- discern";
  std::string results;
  bool json = false;
};

struct MergeArguments {
  std::vector<std::string> runs;
  std::string results;
  bool json = false;
};

struct DoctorArguments {
  std::string results;
  bool strict = false;
  bool json = false;
};

struct SchemaArguments {
  std::string name;
};

struct CompletionsArguments {
  std::string shell;  ///< bash | zsh | fish
};

/// Prints the manual page.
struct ManArguments {};

/// Serves repetitions to a harness; not for people.
struct WorkerArguments {};

/// Tries one graphics platform out; not for people.
struct ProbeDeviceArguments {
  std::string platform;
};

using VerbArguments =
    std::variant<TextArguments, ListArguments, CheckArguments, RunArguments, RenderArguments,
                 DiffArguments, ThresholdsArguments, RefArguments, ReportArguments, EvalArguments,
                 ClaimsArguments, PapersArguments, AcceptArguments, CompareArguments,
                 FigureArguments, ViewArguments, TableArguments, CheapestArguments,
                 HistoryArguments, BisectArguments, MergeArguments, DoctorArguments,
                 SchemaArguments, CompletionsArguments, ManArguments, WorkerArguments,
                 ProbeDeviceArguments>;

}  // namespace suites::command_line

#include "suites/command_line/verb_spec.h"

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/table_formats.h"
#include "suites/command_line/device_probe.h"
#include "suites/command_line/known_words.h"

namespace suites::command_line {

constexpr const char* kRepeatable = " (repeatable)";

OptionSpec* OptionSpec::one_of(std::vector<std::string> words, const std::string& noun) {
  choices = std::move(words);
  store = [take = std::move(store), known = choices, name = name, noun](const std::string& word) {
    require_known(word, known, name, noun);
    take(word);
  };
  return this;
}

OptionSpec* VerbSpec::add(OptionSpec option) {
  options_.push_back(std::make_unique<OptionSpec>(std::move(option)));
  return options_.back().get();
}

OptionSpec* VerbSpec::add_option(const std::string& name, std::string& target,
                                 const std::string& doc) {
  OptionSpec* option = add_option(
      name, [&target](const std::string& word) { target = word; }, doc);
  option->current_ = target;
  return option;
}

OptionSpec* VerbSpec::add_option(const std::string& name, std::vector<std::string>& target,
                                 const std::string& doc) {
  OptionSpec* option = add_option(
      name, [&target](const std::string& word) { target.push_back(word); }, doc);
  option->kind = OptionSpec::Kind::list;
  return option;
}

OptionSpec* VerbSpec::add_option(const std::string& name,
                                 std::function<void(const std::string&)> store,
                                 const std::string& doc) {
  OptionSpec option;
  option.name = name;
  option.doc = doc;
  option.store = std::move(store);
  return add(std::move(option));
}

OptionSpec* VerbSpec::add_flag(const std::string& name, bool& target, const std::string& doc) {
  OptionSpec* option = add_option(
      name, [&target](const std::string&) { target = true; }, doc);
  option->kind = OptionSpec::Kind::flag;
  return option;
}

OptionSpec* add_number(VerbSpec& verb, const std::string& name, std::optional<double>& target,
                       const std::string& doc) {
  const auto store = [&target, name](const std::string& text) {
    target = parse_number_option(text, name);
  };
  return verb.add_option(name, store, doc)->type_name("NUMBER");
}

OptionSpec* add_list(VerbSpec& verb, const std::string& name, std::vector<std::string>& target,
                     const std::string& doc) {
  return verb.add_option(name, target, doc + kRepeatable);
}

void add_table_format(VerbSpec& verb, std::string& target) {
  const std::vector<std::string> names(results::kTableFormats.begin(),
                                       results::kTableFormats.end());
  verb.add_option("--format", target,
                  fmt::format("{} (default: {})", fmt::join(names, " | "), target))
      ->one_of(names, "format");
}

void add_results(VerbSpec& verb, std::string& target) {
  verb.add_option("--results", target,
                  "results folder (default: $DISCERN_RESULTS, else results/ of the checkout)")
      ->type_name("DIR");
}

void add_run(VerbSpec& verb, std::string& target) {
  verb.add_option("run", target, "run folder, id, suite name or \"last\"")
      ->type_name("RUN")
      ->required();
}

void add_run_option(VerbSpec& verb, std::string& target) {
  verb.add_option("--run", target, "run folder, id or \"last\" (default: the suite's newest)")
      ->type_name("RUN");
}

void add_suite(VerbSpec& verb, std::string& target) {
  verb.add_option("suite", target, "suite file or catalogue name")->type_name("SUITE")->required();
}

void add_threads(VerbSpec& verb, int& target) {
  add_integer(verb, "--threads", target, 1, "threads (default: one per core)");
}

void add_device(VerbSpec& verb, std::string& target) {
  const std::vector<std::string> known = known_devices();
  const std::string doc = fmt::format("where OpenGL renderers run: {}", fmt::join(known, ", "));
  verb.add_option("--device", target, doc)->one_of(known, "device");
}

void add_share(VerbSpec& verb, const std::string& name, std::optional<double>& target,
               const std::string& doc) {
  const auto store = [&target, name](const std::string& text) {
    target = parse_share_option(text, name);
  };
  verb.add_option(name, store, doc)->type_name("SHARE");
}

void add_selection(VerbSpec& verb, SuiteSelection& selection) {
  verb.add_option("suite", selection.suite, "suite file or catalogue name")->type_name("SUITE");
  verb.add_option("--profile", selection.profile, "sizes and counts of this profile");
  verb.add_option("--filter", selection.filter, "only cells whose scene, method or name match")
      ->type_name("REGEX");
}

void add_counts(VerbSpec& verb, SuiteSelection& selection) {
  add_integer(verb, "--seeds", selection.seeds, 1, "number of seeds instead of the suite's");
  add_integer(verb, "--repetitions", selection.repetitions, 1,
              "repetitions of every cell instead of the suite's");
}

std::vector<std::string> shown_names(const Verbs& verbs) {
  std::vector<std::string> names;
  for (const auto& verb : verbs) {
    if (!verb->is_hidden()) names.push_back(verb->name());
  }
  return names;
}

Verbs all_verbs() {
  Verbs verbs;
  add_measuring_verbs(verbs);
  add_results_verbs(verbs);
  add_program_verbs(verbs);
  return verbs;
}

}  // namespace suites::command_line

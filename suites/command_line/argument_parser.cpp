#include "suites/command_line/argument_parser.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "perception/base/errors.h"
#include "suites/command_line/known_words.h"
#include "suites/command_line/verb_spec.h"

namespace suites::command_line {

namespace {

void add_to(CLI::App& app, const OptionSpec& spec) {
  CLI::Option* option = nullptr;
  switch (spec.kind) {
    case OptionSpec::Kind::flag:
      option = app.add_flag_callback(
          spec.name, [&spec] { spec.store(""); }, spec.doc);
      break;
    case OptionSpec::Kind::value:
      option = app.add_option_function<std::string>(spec.name, spec.store, spec.doc);
      break;
    case OptionSpec::Kind::list:
      option = app.add_option_function<std::vector<std::string>>(
          spec.name,
          [&spec](const std::vector<std::string>& words) {
            for (const std::string& word : words) spec.store(word);
          },
          spec.doc);
      if (!spec.is_positional()) option->allow_extra_args(false);
      break;
  }
  if (spec.kind != OptionSpec::Kind::flag) option->type_name(spec.value_name);
  if (spec.is_required) option->required();
  if (!spec.heading.empty()) option->group(spec.heading);
  if (!spec.shown_default.empty()) option->default_str(spec.shown_default);
}

void add_to(CLI::App& app, const Verbs& verbs) {
  for (const auto& verb : verbs) {
    CLI::App* sub = app.add_subcommand(verb->name(), verb->doc());
    if (verb->is_hidden()) sub->group("");
    for (const auto& option : verb->options()) add_to(*sub, *option);
  }
}

std::vector<KnownOption> options_of(const VerbSpec& verb) {
  std::vector<KnownOption> options{{"--help", false}};
  for (const auto& option : verb.options()) {
    if (option->is_positional()) continue;
    options.push_back({option->name, option->kind != OptionSpec::Kind::flag});
  }
  return options;
}

const VerbSpec& find_verb(const Verbs& verbs, const std::string& word) {
  for (const auto& verb : verbs) {
    if (verb->name() == word) return *verb;
  }
  throw base::InputError(base::unknown_name("verb", word, shown_names(verbs)));
}

}  // namespace

VerbArguments parse_arguments(const std::vector<std::string>& words) {
  const Verbs verbs = all_verbs();
  CLI::App app(
      "Renders scenes with many techniques, times every stage, says how visible errors are.",
      "discern");
  app.set_help_flag("-h,--help", "print this help");
  app.get_formatter()->column_width(32);
  bool wants_version = false;
  app.add_flag("--version", wants_version, "print the version");
  add_to(app, verbs);
  const bool has_verb = !words.empty() && words.front().rfind('-', 0) != 0;
  const VerbSpec* verb = has_verb ? &find_verb(verbs, words.front()) : nullptr;
  const std::string where = verb == nullptr ? "discern" : "discern " + words.front();
  if (verb != nullptr) refuse_unknown_options(options_of(*verb), words);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::CallForHelp&) {
    return TextArguments{app.help()};
  } catch (const CLI::ParseError& error) {
    throw base::InputError({where}, fmt::format("{}; see {} --help", error.what(), where));
  }
  if (wants_version) return TextArguments{"discern " DISCERN_VERSION "\n"};
  if (verb == nullptr) throw base::InputError(no_verb_message(shown_names(verbs)));
  return verb->arguments();
}

}  // namespace suites::command_line

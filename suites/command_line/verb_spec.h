#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "suites/command_line/option_values.h"
#include "suites/command_line/verb_arguments.h"

/// What the verbs take, told once: the parser, its help and all else that lists options reads it.
namespace suites::command_line {

/// An option, a flag, or a word by its place.
class OptionSpec {
 public:
  enum class Kind { value, list, flag };

  std::string name;  ///< "--seed"; without dashes it is a word by its place
  std::string doc;
  Kind kind = Kind::value;
  std::function<void(const std::string&)> store;  ///< takes each word in; of a flag it is empty
  /// What help calls the value. FILE, DIR, RUN, SUITE, SCENE, RENDERER, METHOD and METRIC say what
  /// a shell offers.
  std::string value_name = "TEXT";
  std::string heading;               ///< of the help; "" for the common one
  std::string shown_default;         ///< "" if help shows none
  std::vector<std::string> choices;  ///< the words it takes; empty: any
  bool is_required = false;

  bool is_positional() const { return !name.starts_with('-'); }
  OptionSpec* required() {
    is_required = true;
    return this;
  }
  OptionSpec* type_name(const std::string& text) {
    value_name = text;
    return this;
  }
  OptionSpec* group(const std::string& text) {
    heading = text;
    return this;
  }
  /// Words that a shell offers; who reads them says what is wrong with others.
  OptionSpec* suggest(std::vector<std::string> words) {
    choices = std::move(words);
    return this;
  }
  /// It takes these words alone.
  /// @param noun  what messages call them, "format"
  OptionSpec* one_of(std::vector<std::string> words, const std::string& noun);
  /// Help shows the value that the target has before parsing.
  OptionSpec* capture_default_str() {
    shown_default = current_;
    return this;
  }

 private:
  friend class VerbSpec;
  std::string current_;
};

/// A verb: its options, and the arguments that they fill.
class VerbSpec {
 public:
  VerbSpec(std::string name, std::string doc, std::function<VerbArguments()> arguments)
      : name_(std::move(name)), doc_(std::move(doc)), arguments_(std::move(arguments)) {}

  const std::string& name() const { return name_; }
  const std::string& doc() const { return doc_; }
  bool is_hidden() const { return is_hidden_; }
  const std::vector<std::unique_ptr<OptionSpec>>& options() const { return options_; }
  /// As the stored words left them.
  VerbArguments arguments() const { return arguments_(); }

  /// Not for people: help does not list it.
  void hide() { is_hidden_ = true; }
  /// Targets must live as long as the verb. @return for further words about the option
  OptionSpec* add_option(const std::string& name, std::string& target, const std::string& doc);
  OptionSpec* add_option(const std::string& name, std::vector<std::string>& target,
                         const std::string& doc);
  /// @param store  may throw base::InputError
  OptionSpec* add_option(const std::string& name, std::function<void(const std::string&)> store,
                         const std::string& doc);
  OptionSpec* add_flag(const std::string& name, bool& target, const std::string& doc);

 private:
  OptionSpec* add(OptionSpec option);
  std::string name_;
  std::string doc_;
  std::function<VerbArguments()> arguments_;
  std::vector<std::unique_ptr<OptionSpec>> options_;
  bool is_hidden_ = false;
};

using Verbs = std::vector<std::unique_ptr<VerbSpec>>;

/// Adds a verb, with --json if its arguments know it; the arguments live as long as the verb.
template <typename Arguments>
std::pair<VerbSpec*, Arguments*> add_verb(Verbs& verbs, const std::string& name,
                                          const std::string& doc) {
  auto arguments = std::make_shared<Arguments>();
  verbs.push_back(std::make_unique<VerbSpec>(name, doc, [arguments] { return *arguments; }));
  VerbSpec* verb = verbs.back().get();
  if constexpr (requires { arguments->json; }) {
    verb->add_flag("--json", arguments->json, "print one JSON object on stdout, also on failure");
  }
  return {verb, arguments.get()};
}

/// An option with one whole number >= low; the target is an integer or an optional of one.
template <typename Target>
OptionSpec* add_integer(VerbSpec& verb, const std::string& name, Target& target, std::int64_t low,
                        const std::string& doc) {
  const auto store = [&target, name, low](const std::string& text) {
    const std::int64_t value = parse_integer_option(text, name, low);
    if constexpr (std::is_integral_v<Target>) target = static_cast<Target>(value);
    if constexpr (!std::is_integral_v<Target>) target = value;
  };
  return verb.add_option(name, store, doc)->type_name("N");
}

OptionSpec* add_number(VerbSpec& verb, const std::string& name, std::optional<double>& target,
                       const std::string& doc);
/// A text option that takes one word each time and may be given often.
OptionSpec* add_list(VerbSpec& verb, const std::string& name, std::vector<std::string>& target,
                     const std::string& doc);
void add_results(VerbSpec& verb, std::string& target);
/// The word `run`: one that is stored.
void add_run(VerbSpec& verb, std::string& target);
/// --run of a verb whose word is the suite.
void add_run_option(VerbSpec& verb, std::string& target);
/// The word `suite`, required.
void add_suite(VerbSpec& verb, std::string& target);
/// --format: one of results::kTableFormats.
void add_table_format(VerbSpec& verb, std::string& target);
void add_threads(VerbSpec& verb, int& target);
void add_device(VerbSpec& verb, std::string& target);
/// A share between 0 and 1, or a percentage.
void add_share(VerbSpec& verb, const std::string& name, std::optional<double>& target,
               const std::string& doc);
void add_selection(VerbSpec& verb, SuiteSelection& selection);
void add_counts(VerbSpec& verb, SuiteSelection& selection);

/// The verbs of measuring_verbs.cpp and results_verbs.cpp, in the order of the help.
void add_measuring_verbs(Verbs& verbs);
void add_results_verbs(Verbs& verbs);
void add_program_verbs(Verbs& verbs);
/// All of them.
Verbs all_verbs();
/// Names of those that are for people.
std::vector<std::string> shown_names(const Verbs& verbs);

}  // namespace suites::command_line

#include "suites/command_line/completions.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace suites::command_line {

namespace {

/// What stands for a value of an option: words, names that the program lists, files or folders.
struct Values {
  std::vector<std::string> words;
  std::string listed;  ///< "suites": `discern list suites --names`; "" for none
  bool are_files = false;
  bool are_folders = false;

  bool is_known() const { return !words.empty() || !listed.empty() || are_files || are_folders; }
};

Values values_of(const OptionSpec& option) {
  static const std::map<std::string, std::string> kListed{{"SUITE", "suites"},
                                                          {"SCENE", "scenes"},
                                                          {"RENDERER", "renderers"},
                                                          {"METHOD", "renderers"},
                                                          {"METRIC", "metrics"}};
  static const std::set<std::string> kPaths{"FILE", "RUN", "SUITE", "SCENE"};
  Values values;
  values.words = option.choices;
  const auto entry = kListed.find(option.value_name);
  if (entry != kListed.end()) values.listed = entry->second;
  values.are_folders = option.value_name == "DIR";
  values.are_files = kPaths.contains(option.value_name);
  return values;
}

/// The words between which bash chooses, as shell text.
std::string bash_words(const Values& values) {
  std::string text = fmt::format("{}", fmt::join(values.words, " "));
  if (!values.listed.empty()) {
    text += fmt::format("{}$(\"${{COMP_WORDS[0]}}\" list {} --names 2>/dev/null)",
                        text.empty() ? "" : " ", values.listed);
  }
  return text;
}

std::string bash_choice(const Values& values) {
  std::string text;
  const std::string words = bash_words(values);
  if (!words.empty()) text += fmt::format("COMPREPLY=($(compgen -W \"{}\" -- \"$cur\"))", words);
  const char* kind = values.are_folders ? "-d" : values.are_files ? "-f" : nullptr;
  if (kind != nullptr) {
    text += fmt::format("{}COMPREPLY+=($(compgen {} -- \"$cur\"))", text.empty() ? "" : "; ", kind);
  }
  return text.empty() ? "COMPREPLY=()" : text;
}

/// Cases for the word behind an option of a verb, then for all else of the verb.
std::string bash_cases(const VerbSpec& verb) {
  std::string text;
  Values by_place;
  std::vector<std::string> names{"--help"};
  for (const auto& option : verb.options()) {
    const Values values = values_of(*option);
    if (option->is_positional()) {
      by_place.words.insert(by_place.words.end(), values.words.begin(), values.words.end());
      if (by_place.listed.empty()) by_place.listed = values.listed;
      by_place.are_files |= values.are_files;
      continue;
    }
    names.push_back(option->name);
    if (option->kind == OptionSpec::Kind::flag) continue;
    text += fmt::format("    '{} {}') {} ;;\n", verb.name(), option->name, bash_choice(values));
  }
  Values options;
  options.words = names;
  text += fmt::format("    '{} '*) if [[ $cur == -* ]]; then {}; else {}; fi ;;\n", verb.name(),
                      bash_choice(options), bash_choice(by_place));
  return text;
}

/// Text between single quotes of fish.
std::string fish_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') result += '\\';
    result += c;
  }
  return result + "'";
}

std::string fish_values(const Values& values) {
  std::string words = fmt::format("{}", fmt::join(values.words, " "));
  if (!values.listed.empty()) words = fmt::format("(discern list {} --names)", values.listed);
  if (values.are_folders) words = "(__fish_complete_directories)";
  std::string text = values.are_files ? " -r" : " -x";
  if (!words.empty())
    text += " -a " + (words.front() == '(' ? "\"" + words + "\"" : fish_quoted(words));
  return text;
}

}  // namespace

std::string bash_completions(const Verbs& verbs) {
  Values first;
  first.words = shown_names(verbs);
  first.words.insert(first.words.end(), {"--help", "--version"});
  std::string text =
      "# bash completion of discern: source <(discern completions bash)\n"
      "_discern() {\n"
      "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}\n"
      "  COMPREPLY=()\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    " +
      bash_choice(first) +
      "\n    return\n  fi\n"
      "  case \"${COMP_WORDS[1]} $prev\" in\n";
  for (const auto& verb : verbs) {
    if (!verb->is_hidden()) text += bash_cases(*verb);
  }
  return text + "  esac\n}\ncomplete -o filenames -F _discern discern\n";
}

std::string zsh_completions(const Verbs& verbs) {
  return "#compdef discern\n# zsh completion of discern: source <(discern completions zsh)\n"
         "autoload -U +X bashcompinit && bashcompinit\n" +
         bash_completions(verbs);
}

std::string fish_completions(const Verbs& verbs) {
  std::string text =
      "# fish completion of discern: discern completions fish | source\n"
      "complete -c discern -f\n";
  for (const auto& verb : verbs) {
    if (verb->is_hidden()) continue;
    text += fmt::format("complete -c discern -n __fish_use_subcommand -a {} -d {}\n", verb->name(),
                        fish_quoted(verb->doc()));
    const std::string when =
        fmt::format("complete -c discern -n '__fish_seen_subcommand_from {}'", verb->name());
    for (const auto& option : verb->options()) {
      const Values values = values_of(*option);
      if (option->is_positional()) {
        if (values.is_known()) text += when + fish_values(values) + "\n";
        continue;
      }
      const bool is_flag = option->kind == OptionSpec::Kind::flag;
      text += fmt::format("{} -l {}{} -d {}\n", when, option->name.substr(2),
                          is_flag ? "" : fish_values(values), fish_quoted(option->doc));
    }
  }
  return text;
}

}  // namespace suites::command_line

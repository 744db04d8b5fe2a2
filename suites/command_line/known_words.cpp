#include "suites/command_line/known_words.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "perception/base/errors.h"

namespace suites::command_line {

void refuse_unknown_options(const std::vector<KnownOption>& known,
                            const std::vector<std::string>& words) {
  for (std::size_t i = 1; i < words.size() && words[i] != "--"; ++i) {
    if (words[i].rfind("--", 0) != 0) continue;
    const std::size_t equals = words[i].find('=');
    const std::string name = words[i].substr(0, equals);
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&name](const KnownOption& o) { return o.name == name; });
    if (found == known.end()) {
      std::vector<std::string> names;
      for (const KnownOption& option : known) names.push_back(option.name);
      throw base::InputError({"discern " + words.front()},
                             base::unknown_name("option", name, names));
    }
    // The word after an option with a value is that value, whatever it looks like.
    if (equals == std::string::npos && found->takes_value) ++i;
  }
}

void require_known(const std::string& word, const std::vector<std::string>& known,
                   const std::string& where, const std::string& kind) {
  if (std::find(known.begin(), known.end(), word) != known.end()) return;
  throw base::InputError({where}, base::unknown_name(kind, word, known));
}

std::string quoted_command(const std::vector<std::string>& words) {
  static constexpr std::string_view kSpecial = " \t\n\"'\\$`*?[]{}()<>|&;#~!";
  std::string command = "discern";
  for (const std::string& word : words) {
    const bool is_plain = !word.empty() && word.find_first_of(kSpecial) == std::string::npos;
    if (is_plain) {
      command += ' ' + word;
      continue;
    }
    command += " '";
    for (const char c : word) command += c == '\'' ? std::string("'\\''") : std::string(1, c);
    command += '\'';
  }
  return command;
}

std::string no_verb_message(const std::vector<std::string>& verbs) {
  return fmt::format("no verb given; known: {}; see discern --help", fmt::join(verbs, ", "));
}

bool asks_for_json(const std::vector<std::string>& words) {
  return std::find(words.begin(), words.end(), "--json") != words.end();
}

}  // namespace suites::command_line

#pragma once

#include <string>
#include <vector>

namespace suites::command_line {

/// A long option of a verb.
struct KnownOption {
  std::string name;  ///< "--size"
  bool takes_value = false;
};

/// Looks at every word that starts with `--` and is not the value of an option.
/// @param words  the command line; the first one is the verb
/// @throws base::InputError for an option that is not known, with the nearest one
void refuse_unknown_options(const std::vector<KnownOption>& known,
                            const std::vector<std::string>& words);

/// Refuses a word that is not in a list.
/// @param where  the option or verb it belongs to; @param kind  what the word stands for
/// @throws base::InputError with the nearest known word
void require_known(const std::string& word, const std::vector<std::string>& known,
                   const std::string& where, const std::string& kind);

/// The command line as a shell would read it again: words with special characters are quoted.
std::string quoted_command(const std::vector<std::string>& words);

/// "no verb given; known: ...; see discern --help".
std::string no_verb_message(const std::vector<std::string>& verbs);

/// True if the words ask for JSON, whether they can be parsed or not.
bool asks_for_json(const std::vector<std::string>& words);

}  // namespace suites::command_line

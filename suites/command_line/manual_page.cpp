#include "suites/command_line/manual_page.h"

#include <fmt/format.h>

namespace suites::command_line {

namespace {

/// Text that roff prints as it is: a leading dot or quote would be a request, a hyphen a dash.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) {
      result += std::string("\\&") + c;
    } else {
      result += c;
    }
  }
  return result;
}

std::string value_text(const OptionSpec& option) {
  return option.kind == OptionSpec::Kind::flag ? "" : " \\fI" + roff(option.value_name) + "\\fR";
}

std::string synopsis_of(const VerbSpec& verb) {
  std::string text = fmt::format(".B discern {}\n", roff(verb.name()));
  bool has_options = false;
  for (const auto& option : verb.options()) {
    const bool is_word = option->is_positional();
    if (!is_word && !option->is_required) {
      has_options = true;
      continue;
    }
    const std::string word = is_word ? "\\fI" + roff(option->name) + "\\fR"
                                     : "\\fB" + roff(option->name) + "\\fR" + value_text(*option);
    const std::string more = option->kind == OptionSpec::Kind::list && is_word ? " ..." : "";
    text += option->is_required ? word + more + "\n" : "[" + word + more + "]\n";
  }
  return text + (has_options ? "[\\fIoptions\\fR]\n" : "");
}

std::string section_of(const VerbSpec& verb) {
  std::string text =
      fmt::format(".SS {}\n{}.PP\n{}.\n", roff(verb.name()), synopsis_of(verb), roff(verb.doc()));
  for (const auto& option : verb.options()) {
    const std::string name = option->is_positional()
                                 ? "\\fI" + roff(option->name) + "\\fR"
                                 : "\\fB" + roff(option->name) + "\\fR" + value_text(*option);
    text += fmt::format(".TP\n{}\n{}", name, roff(option->doc));
    if (!option->shown_default.empty()) text += roff(" (default: " + option->shown_default + ")");
    text += '\n';
  }
  return text;
}

constexpr const char* kStatusAndFiles = R"(.SH "EXIT STATUS"
.TP
0
as expected
.TP
1
a gate failed, a row is worse, a limit was passed
.TP
2
a mistake in the command line or in an input
.TP
3
some cells or references failed
.TP
4
nothing was measured
.TP
5
with \fB\-\-strict\fR: inconclusive, or not measured; of \fBbisect\fR: not one commit
.TP
130
interrupted; run the command again to go on
.SH ENVIRONMENT
.TP
.B DISCERN_RESULTS
results folder, where \fB\-\-results\fR is not given
.TP
.B DISCERN_SUITES
folder of the suites that are named, in place of the checkout's
.TP
.B DISCERN_SCENES
folder of the scenes that are named, in place of the checkout's
.TP
.B NO_COLOR
no colours on a terminal
)";

}  // namespace

std::string manual_page(const Verbs& verbs, const std::string& version) {
  std::string text = fmt::format(
      ".TH DISCERN 1 \"\" \"discern {}\" \"User Commands\"\n.SH NAME\n"
      "discern \\- renders scenes with many techniques, times every stage, says how visible errors "
      "are\n.SH SYNOPSIS\n.B discern\n\\fIverb\\fR [\\fIarguments\\fR]\n.PP\n.B "
      "discern\n\\fIverb\\fR "
      "\\fB\\-\\-help\\fR\n.SH VERBS\n",
      roff(version));
  for (const auto& verb : verbs) {
    if (!verb->is_hidden()) text += section_of(*verb);
  }
  return text + kStatusAndFiles;
}

}  // namespace suites::command_line

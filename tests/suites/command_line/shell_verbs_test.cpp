#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "suites/command_line/verb_spec.h"
#include "tests/places.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

class ShellVerbs : public ProgramTest {
 protected:
  /// What a real bash offers for the last word of a command line.
  std::vector<std::string> offered(const std::vector<std::string>& words) const {
    const std::string script =
        "source \"$1\"; shift; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _discern; "
        "printf '%s\\n' \"${COMPREPLY[@]}\"";
    std::vector<std::string> command{"bash", "--norc", "-c", script, "bash", script_, kProgram};
    command.insert(command.end(), words.begin(), words.end());
    const base::CommandResult result =
        base::run_command(command, std::chrono::seconds(30), environment());
    EXPECT_EQ(result.exit.code, 0) << result.stderr_text;
    EXPECT_EQ(result.stderr_text, "");
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < result.stdout_text.size();) {
      const std::size_t end = result.stdout_text.find('\n', begin);
      if (end > begin) lines.push_back(result.stdout_text.substr(begin, end - begin));
      begin = end + 1;
    }
    return lines;
  }
  void SetUp() override {
    script_ = write_text("discern.bash", discern({"completions", "bash"}).stdout_text);
  }

  static bool offers(const std::vector<std::string>& words, const std::string& word) {
    return std::ranges::find(words, word) != words.end();
  }
  /// Hyphens as roff writes them.
  static std::string with_dashes(std::string text) {
    for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos; at += 2) {
      text.insert(at, 1, '\\');
    }
    return text;
  }

  std::string script_;
};

using Words = std::vector<std::string>;

TEST_F(ShellVerbs, BashOffersVerbsOptionsAndNames) {
  EXPECT_EQ(offered({"rend"}), Words{"render"});
  EXPECT_EQ(offered({"worke"}), Words{}) << "verbs that are not for people";
  EXPECT_EQ(offered({"render", "--scen"}), Words{"--scene"});
  EXPECT_EQ(offered({"render", "--scene", "furnac"}), Words{"furnace"});
  EXPECT_EQ(offered({"render", "--renderer", "instant"}), Words{"instant-radiosity"});
  EXPECT_EQ(offered({"diff", "--metric", "ms-"}), Words{"ms-ssim"});
  EXPECT_EQ(offered({"run", "--device", "egl-s"}), Words{"egl-surfaceless"});
  EXPECT_EQ(offered({"run", "quic"}), Words{"quick"});
  EXPECT_EQ(offered({"table", "last", "--format", "ma"}), Words{"markdown"});
  EXPECT_EQ(offered({"list", "dev"}), Words{"devices"});
  EXPECT_EQ(offered({"diff", script_.substr(0, script_.size() - 2)}), Words{script_});
}

/// zsh by way of bash's function, fish by rules of its own; every option of every verb is there.
TEST_F(ShellVerbs, EveryOptionIsInEveryShellAndInTheManual) {
  const std::string fish = discern({"completions", "fish"}).stdout_text;
  const std::string bash = discern({"completions", "bash"}).stdout_text;
  const std::string zsh = discern({"completions", "zsh"}).stdout_text;
  EXPECT_TRUE(zsh.starts_with("#compdef discern\n"));
  EXPECT_TRUE(zsh.ends_with(bash));
  const std::string manual = discern({"man"}).stdout_text;
  for (const auto& verb : suites::command_line::all_verbs()) {
    const std::string section =
        fmt::format(".SS {}\n", verb->name() == "probe-device" ? "probe\\-device" : verb->name());
    EXPECT_EQ(manual.find(section) != std::string::npos, !verb->is_hidden()) << verb->name();
    if (verb->is_hidden()) continue;
    for (const auto& option : verb->options()) {
      if (option->is_positional()) continue;
      const std::string rule = fmt::format("'__fish_seen_subcommand_from {}' -l {} ", verb->name(),
                                           option->name.substr(2));
      EXPECT_NE(fish.find(rule), std::string::npos) << rule;
      EXPECT_TRUE(offers(offered({verb->name(), option->name}), option->name))
          << verb->name() << ' ' << option->name;
      EXPECT_NE(manual.find("\\fB" + with_dashes(option->name)), std::string::npos);
    }
  }
}

TEST_F(ShellVerbs, TheManualIsGoodRoff) {
  const base::CommandResult has_groff =
      base::run_command({"/bin/sh", "-c", "command -v groff"}, std::chrono::seconds(10));
  if (has_groff.exit.code != 0) GTEST_SKIP() << "needs groff";
  const std::string page = write_text("discern.1", discern({"man"}).stdout_text);
  const base::CommandResult result =
      base::run_command({"groff", "-man", "-ww", "-z", page}, std::chrono::seconds(30));
  EXPECT_EQ(result.stdout_text + result.stderr_text, "");
}

TEST_F(ShellVerbs, ListsNamesAlone) {
  const std::string names = discern({"list", "renderers", "--names"}).stdout_text;
  EXPECT_EQ(names.find(' '), std::string::npos);
  EXPECT_NE(names.find("\npath\n"), std::string::npos);
  EXPECT_EQ(discern({"list", "scenes", "--names", "--filter", "^furnace$"}).stdout_text,
            "furnace\n");
  EXPECT_EQ(discern({"list", "suites", "--names", "--filter", "^quick$"}).stdout_text, "quick\n");
  EXPECT_EQ(discern({"list", "metrics", "--names", "--filter", "^flip$"}).stdout_text, "flip\n");
  EXPECT_EQ(discern({"list", "devices", "--names"}).stdout_text,
            "auto\negl-device\negl-surfaceless\nosmesa\n");
}

}  // namespace
}  // namespace tests

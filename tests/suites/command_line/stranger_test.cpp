#include <algorithm>

#include <fmt/format.h>

#include "perception/base/atomic_file.h"
#include "tests/places.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

/// A suite and a scene by someone who wishes ill; what it does must stay below `results`.
class Stranger : public ProgramTest {
 protected:
  Stranger() {
    write_text("files/box.yaml",
               fmt::format("schema: 1\nscene: box\nsummary: \"<script>alert(5)</script>\\e[31m\"\n"
                           "include: {}/suites/scenes/cornell-box.yaml\n",
                           kSourceFolder));
  }

  /// A small suite with words of its own in some places.
  std::string suite(const std::string& more, const std::string& methods = kMethods) const {
    return write_text(
        "files/suite.yaml",
        "schema: 1\nsuite: stranger\n"
        "viewing: {ppd: 60, display: {peak_cd_m2: 200, black_cd_m2: 0.2, ambient_lux: 250},"
        " exposure: scene}\n"
        "scenes: [{id: box, file: box.yaml, size: [16, 16], "
        "reference: {renderer: path, samples: 4}}]\n"
        "measure: {seeds: 1, repetitions: {min: 1, max: 1}}\nmetrics: [relmse]\n" +
            methods + more);
  }

  /// Every file below the folder of the test, but for those below `results`.
  std::vector<std::string> files_outside_results() const {
    std::vector<std::string> files;
    for (auto entry = fs::recursive_directory_iterator(folder()); entry != fs::end(entry);
         ++entry) {
      const std::string name = fs::relative(entry->path(), folder()).string();
      if (name == "results") {
        entry.disable_recursion_pending();
      } else {
        files.push_back(name);
      }
    }
    std::ranges::sort(files);
    return files;
  }

  /// The only run there is.
  fs::path run() const {
    for (const auto& entry : fs::directory_iterator(folder() / "results/runs/stranger")) {
      return entry.path();
    }
    return {};
  }

  fs::path folder_of_mine() const { return folder() / "mine"; }

  void replace_in(const fs::path& file, const std::string& from, const std::string& to) const {
    std::string text = base::read_text_file(file);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    base::write_text_file(file, text.replace(at, from.size(), to));
  }

  static constexpr const char* kMethods =
      "methods: [{id: pt, renderer: path, matrix: {max_depth: [2, 3]}, budgets: [{samples: 1}]}]\n";
};

TEST_F(Stranger, NamesThatWouldLeaveTheResultsFolderAreRefused) {
  const std::string file = path("files/suite.yaml");
  const std::string accepted =
      " cannot be a file name; accepted: letters, digits, . _ -, not starting with . or -";
  const auto refused = [&](const std::string& what, const std::string& name) {
    const auto result = discern({"check", file});
    EXPECT_EQ(result.exit.code, 2) << what;
    EXPECT_NE(result.stderr_text.find(what + " \"" + name + "\"" + accepted), std::string::npos)
        << result.stderr_text;
  };
  for (const std::string name : {"../x", "/tmp/x", "a/b", ".hidden", "-rf", ""}) {
    suite("profiles: {\"" + name + "\": {measure: {seeds: 1}}}\n");
    refused("profile", name);
    suite("", "methods: [{id: \"" + name + "\", renderer: path}]\n");
    refused("id", name);
    suite("");
    replace_in(file, "suite: stranger", "suite: \"" + name + "\"");
    refused("suite", name);
    suite("");
    replace_in(file, "id: box", "id: \"" + name + "\"");
    refused("id", name);
  }
  for (const char* more :
       {"figures: [{id: ../f, kind: pareto, y: [relmse]}]\n",
        "claims: [{id: ../c, item: a, says: b, measure: \"1\", expect: \"= 1\"}]\n"}) {
    suite(more);
    const auto result = discern({"check", file});
    EXPECT_EQ(result.exit.code, 2) << more;
    EXPECT_NE(result.stderr_text.find("../"), std::string::npos) << result.stderr_text;
  }
}

TEST_F(Stranger, NoKeyNamesAProgram) {
  const std::string evil = write_text("files/evil.sh", "#!/bin/sh\ntouch " + path("pwned") + "\n");
  fs::permissions(evil, fs::perms::owner_all);
  suite("");
  const auto before = files_outside_results();
  for (const std::string key : {"command", "program", "executable", "build", "hook", "viewer"}) {
    const auto result = discern({"check", suite(key + ": " + evil + "\n")});
    EXPECT_EQ(result.exit.code, 2);
    EXPECT_NE(result.stderr_text.find("unknown key \"" + key + "\""), std::string::npos)
        << result.stderr_text;
  }
  for (const std::string& methods :
       {"methods: [{id: a, renderer: \"" + evil + "\"}]\n",
        "methods: [{id: a, renderer: path, command: \"" + evil + "\"}]\n",
        "methods: [{id: a, renderer: path, parameters: {program: \"" + evil + "\"}}]\n"}) {
    EXPECT_EQ(discern({"check", suite("", methods)}).exit.code, 2) << methods;
  }
  EXPECT_EQ(files_outside_results(), before);
}

TEST_F(Stranger, ARunOfHostileTextsWritesInTheResultsOnlyAndIsEscaped) {
  const std::string text =
      R"(</script><img src=x onerror=alert(1)> `touch pwned` '\" $(touch pwned) \e[31m\u202e)";
  const std::string file =
      suite("summary: \"" + text + "\"\nclaims: [{id: c, item: \"" + text + "\", says: \"" + text +
            "\", measure: \"value(pt[max_depth=2], relmse)\", expect: \"< 9\", printed: \"" + text +
            "\"}]\nfigures: [{id: f, kind: error-vs-parameter, x: max_depth, y: [relmse], "
            "methods: [pt], title: \"" +
            text + "\"}]\n");
  const auto before = files_outside_results();
  const auto made = discern({"run", file});
  EXPECT_EQ(made.exit.code, 0) << made.stderr_text;
  const std::string html = base::read_text_file(run() / "report/index.html");
  EXPECT_EQ(html.find("<img src=x"), std::string::npos);
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_NE(html.find("&lt;/script&gt;&lt;img src=x onerror=alert(1)&gt;"), std::string::npos);
  EXPECT_EQ(html.find("\u202e"), std::string::npos);
  EXPECT_NE(html.find("\\u202e"), std::string::npos);
  EXPECT_NE(html.find("Content-Security-Policy\" content=\"default-src 'none'"), std::string::npos);
  const auto drawn = discern({"figure", file});
  EXPECT_EQ(drawn.exit.code, 0) << drawn.stderr_text;
  EXPECT_EQ(discern({"claims", file}).exit.code, 0);
  EXPECT_EQ(files_outside_results(), before);
}

TEST_F(Stranger, NothingPrintedCommandsTheTerminal) {
  const std::string file = suite("summary: \"a\\e]0;title\\a\\x9b31m\\x7f \\u202eb\"\n");
  const auto checked = discern({"check", file});
  EXPECT_EQ(checked.exit.code, 0) << checked.stderr_text;
  const auto json = discern({"check", file, "--json"});
  EXPECT_TRUE(nlohmann::json::accept(json.stdout_text)) << json.stdout_text;
  EXPECT_NE(checked.stdout_text.find("a\\u001b]0;title\\u0007\\u009b31m\\u007f \\u202eb\n"),
            std::string::npos)
      << checked.stdout_text;
  EXPECT_EQ(nlohmann::json::parse(json.stdout_text).at("summary"),
            "a\x1b]0;title\a\u009b31m\x7f \u202e"
            "b");
  const auto refused = discern({"check", suite("\"\\e[31m\": 1\n")});
  EXPECT_EQ(refused.exit.code, 2);
  EXPECT_NE(refused.stderr_text.find("unknown key \"\\u001b[31m\""), std::string::npos)
      << refused.stderr_text;
  // Words of the command line are bytes of any kind.
  const auto bytes = discern({"check", path("files/\x9b"
                                            "31m\xff.yaml")});
  EXPECT_EQ(bytes.exit.code, 2);
  EXPECT_NE(bytes.stderr_text.find("files/\\x9b31m\\xff.yaml"), std::string::npos)
      << bytes.stderr_text;
}

TEST_F(Stranger, ARunsOwnNamesDoNotLeadOutOfTheResults) {
  ASSERT_EQ(discern({"run", suite("")}).exit.code, 0);
  const std::string folder = run().string();
  const auto before = files_outside_results();
  for (const std::string key : {"suite", "profile"}) {
    const std::string old = key == "suite" ? "stranger" : "";
    const std::string entry = "\"" + key + "\": \"";
    replace_in(run() / "run.json", entry + old, entry + "../../out");
    const std::string message =
        folder + "/run.json: " + key +
        " \"../../out\" cannot be a file name; accepted: letters, digits, . _ -, not "
        "starting with . or -";
    expect_refused({"accept", folder, "--reason", "x"}, message);
    replace_in(run() / "run.json", entry + "../../out", entry + old);
  }
  replace_in(run() / "cells.jsonl", "\"machine\":\"", "\"machine\":\"../../");
  EXPECT_EQ(discern({"accept", folder, "--reason", "x"}).exit.code, 2);
  EXPECT_EQ(files_outside_results(), before);
}

TEST_F(Stranger, LinksInARunAreNotFollowedOnWriting) {
  ASSERT_EQ(discern({"run", suite("")}).exit.code, 0);
  const std::string folder = run().string();
  const std::string mine = write_text("mine.txt", "precious\n");
  fs::create_directory(folder_of_mine());
  const std::string tail =
      ": is a symbolic link; a run is written within its own folder: put the file or folder itself "
      "there";
  const auto refused_with = [&](const std::string& link, const std::string& target) {
    fs::rename(run() / link, folder_of_mine() / "kept");
    fs::create_symlink(target, run() / link);
    expect_refused({"eval", folder}, folder + "/" + link + tail);
    expect_refused({"report", folder}, folder + "/" + link + tail);
    fs::remove(run() / link);
    fs::rename(folder_of_mine() / "kept", run() / link);
  };
  refused_with("lock", mine);
  refused_with("metrics.jsonl", mine);
  refused_with("report", folder_of_mine());
  refused_with("maps", folder_of_mine());
  // Deeper, too: what a report, a figure or a worker's log would be written through.
  const fs::path cell = fs::directory_iterator(run() / "images")->path().filename();
  for (const fs::path& link : {fs::path("report/data.new"), fs::path("figures/mine"),
                               "images" / cell / "more.log", "maps" / cell / "mine"}) {
    fs::create_directories((run() / link).parent_path());
    fs::create_symlink(folder_of_mine(), run() / link);
    expect_refused({"eval", folder}, folder + "/" + link.string() + tail);
    fs::remove(run() / link);
  }
  // A log may be that of another cell of the run, and nothing else.
  const fs::path log = run() / "images" / "zz" / "stderr.log";
  fs::create_directory(log.parent_path());
  fs::create_symlink(mine, log);
  expect_refused({"eval", folder}, log.string() + tail);
  fs::remove(log);
  base::write_text_file(run() / "images" / cell / "stderr.log", "");
  fs::create_symlink(".." / cell / "stderr.log", log);
  EXPECT_EQ(discern({"eval", folder}).exit.code, 0);
  // A kill may have left the link without it.
  fs::remove(run() / "images" / cell / "stderr.log");
  EXPECT_EQ(discern({"eval", folder}).exit.code, 0);
  EXPECT_EQ(base::read_text_file(mine), "precious\n");
  EXPECT_TRUE(fs::is_empty(folder_of_mine()));
}

}  // namespace
}  // namespace tests

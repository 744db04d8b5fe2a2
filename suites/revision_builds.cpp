#include "suites/revision_builds.h"

#include <utility>

#include <fmt/format.h>

#include "perception/base/child_process.h"
#include "perception/base/errors.h"

namespace suites {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::duration<double> kGitTimeout{600.0};
constexpr std::chrono::duration<double> kBuildTimeout{7200.0};

std::string without_line_end(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

/// @throws base::InputError with what git says
std::string git(const fs::path& repository, std::vector<std::string> words) {
  std::vector<std::string> command{"git", "-C", repository.string()};
  command.insert(command.end(), words.begin(), words.end());
  const base::CommandResult result = base::run_command(command, kGitTimeout);
  if (result.exit.code == 0 && result.exit.signal == 0) return result.stdout_text;
  throw base::InputError(fmt::format("git {} in {}: {}", words.front(), repository.string(),
                                     without_line_end(result.stderr_text)));
}

std::string commit_of(const fs::path& source, const std::string& revision) {
  const std::string name = revision + "^{commit}";
  const base::CommandResult result = base::run_command(
      {"git", "-C", source.string(), "rev-parse", "--verify", "--quiet", "--end-of-options", name},
      kGitTimeout);
  if (result.exit.code == 0) return without_line_end(result.stdout_text);
  git(source, {"rev-parse", "--git-dir"});  // says so if it is no repository at all
  throw base::InputError(
      fmt::format("\"{}\" is no commit of {}; accepted: a hash, branch or tag there", revision,
                  fs::absolute(source).string()));
}

Revision described(const fs::path& source, const std::string& commit) {
  return {commit, without_line_end(git(source, {"log", "-1", "--format=%s", commit}))};
}

}  // namespace

std::vector<Revision> revisions_between(const fs::path& source, const std::string& good,
                                        const std::string& bad) {
  const std::string first = commit_of(source, good);
  const std::string last = commit_of(source, bad);
  const base::CommandResult ancestry = base::run_command(
      {"git", "-C", source.string(), "merge-base", "--is-ancestor", first, last}, kGitTimeout);
  if (first == last || ancestry.exit.code != 0) {
    throw base::InputError(
        fmt::format("\"{}\" is no earlier commit than \"{}\"; accepted: a commit that the later "
                    "one came from",
                    good, bad));
  }
  std::vector<Revision> revisions{described(source, first)};
  const std::string list = git(source, {"log", "--first-parent", "--reverse", "--format=%H %s",
                                        fmt::format("{}..{}", first, last)});
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = list.find('\n', begin);
    const std::string line = list.substr(begin, end - begin);
    const std::size_t space = line.find(' ');
    revisions.push_back({line.substr(0, space), line.substr(space + 1)});
    begin = end + 1;
  }
  return revisions;
}

RevisionBuilds::RevisionBuilds(const fs::path& source, fs::path folder, std::string command)
    : folder_(std::move(folder)), command_(std::move(command)) {
  const std::string origin = fs::absolute(source).string();
  const fs::path tree = folder_ / "tree";
  if (!fs::exists(tree / ".git")) {
    fs::create_directories(folder_);
    git(folder_, {"clone", "--quiet", "--no-checkout", origin, tree.string()});
  }
  git(tree, {"fetch", "--quiet", "--force", origin, "+refs/*:refs/source/*"});
}

fs::path RevisionBuilds::build(const Revision& revision) const {
  const fs::path tree = folder_ / "tree";
  git(tree, {"checkout", "--quiet", "--force", "--detach", revision.commit});
  const fs::path log = folder_ / "build.log";
  const base::CommandResult result =
      base::run_command({"/bin/sh", "-c", "cd \"$1\" && { " + command_ + "\n} >\"$2\" 2>&1", "sh",
                         tree.string(), log.string()},
                        kBuildTimeout);
  const fs::path program = tree / "build" / "discern";
  if (result.exit.code == 0 && result.exit.signal == 0 && fs::exists(program)) return program;
  const fs::path kept = folder_ / fmt::format("build-{}.log", revision.commit.substr(0, 10));
  std::error_code error;
  fs::rename(log, kept, error);
  throw base::InputError(
      fmt::format("does not build ({}); log: {}", result.exit.text(), kept.string()));
}

}  // namespace suites

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace suites {

/// A commit of a git repository.
struct Revision {
  std::string commit;   ///< all of its hash
  std::string subject;  ///< first line of its message
};

/// The commits from `good` (first) to `bad` (last) along first parents.
/// @param source  a git repository
/// @throws base::InputError if a revision is unknown, or `good` is no ancestor of `bad`
std::vector<Revision> revisions_between(const std::filesystem::path& source,
                                        const std::string& good, const std::string& bad);

/// Builds revisions one after the other in one clone, so that each costs what changed.
class RevisionBuilds {
 public:
  /// Makes the clone, or brings an earlier one up to date; the source is not touched.
  /// @param folder   of the clone and of the build's log; nothing else may work in it
  /// @param command  shell command, run in the clone, that leaves the program in build/discern
  RevisionBuilds(const std::filesystem::path& source, std::filesystem::path folder,
                 std::string command);

  /// @return the program
  /// @throws base::InputError with the log's path if it does not build
  std::filesystem::path build(const Revision& revision) const;

 private:
  std::filesystem::path folder_;
  std::string command_;
};

}  // namespace suites

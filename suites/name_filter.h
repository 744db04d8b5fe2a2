#pragma once

#include <memory>
#include <string>

namespace suites {

/// A `--filter`: an ECMAScript regular expression that a name must match somewhere; "" matches all.
class NameFilter {
 public:
  /// @throws base::InputError if it is no regular expression, saying why
  explicit NameFilter(const std::string& filter);
  bool matches(const std::string& name) const;

 private:
  struct Pattern;
  std::shared_ptr<const Pattern> pattern_;  ///< null for all
};

}  // namespace suites

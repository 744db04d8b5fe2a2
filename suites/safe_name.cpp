#include "suites/safe_name.h"

#include <fmt/format.h>

#include "perception/base/names.h"

namespace suites {

std::string read_safe_name(const base::Node& node, const char* what) {
  const std::string name = node.scalar_text(what);
  if (!base::is_path_safe(name)) {
    throw base::InputError(node.place(),
                           fmt::format("{} \"{}\" cannot be a file name; accepted: letters, "
                                       "digits, . _ -, not starting with . or -",
                                       what, name));
  }
  return name;
}

}  // namespace suites

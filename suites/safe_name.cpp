#include "suites/safe_name.h"

#include <fmt/format.h>

#include "perception/base/names.h"

namespace suites {

void require_safe_name(const std::string& name, const char* what, const base::Place& place) {
  if (base::is_path_safe(name)) return;
  throw base::InputError(place, fmt::format("{} \"{}\" cannot be a file name; accepted: letters, "
                                            "digits, . _ -, not starting with . or -",
                                            what, name));
}

std::string read_safe_name(const base::Node& node, const char* what) {
  const std::string name = node.scalar_text(what);
  require_safe_name(name, what, node.place());
  return name;
}

}  // namespace suites

#include <algorithm>
#include <cstdlib>

#include "perception/base/errors.h"
#include "suites/suite_file.h"

namespace suites {
namespace {

std::filesystem::path folder_from(const char* variable, const char* in_checkout) {
  const char* value = std::getenv(variable);
  if (value != nullptr && *value != '\0') return value;
  return std::filesystem::path(DISCERN_SOURCE_DIR) / in_checkout;
}

bool is_file_name(const std::string& text) {
  return text.ends_with(".yaml") || text.ends_with(".yml") || text.ends_with(".json");
}

}  // namespace

std::filesystem::path source_folder() { return DISCERN_SOURCE_DIR; }

std::filesystem::path catalog_folder() { return folder_from("DISCERN_SUITES", "suites/catalog"); }

std::filesystem::path scene_folder() { return folder_from("DISCERN_SCENES", "suites/scenes"); }

std::vector<std::string> catalog_suite_names() {
  const std::filesystem::path folder = catalog_folder();
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error)) {
    if (entry.path().extension() != ".yaml") continue;
    names.push_back(std::filesystem::relative(entry.path(), folder).replace_extension().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::filesystem::path find_suite(const std::string& path_or_name) {
  // A catalogue name may have a folder, as a path has: a file that is there comes first.
  const bool is_path = is_file_name(path_or_name) || path_or_name.find('/') != std::string::npos;
  if (is_path && std::filesystem::is_regular_file(path_or_name)) return path_or_name;
  const std::vector<std::string> names = catalog_suite_names();
  const bool is_known = std::find(names.begin(), names.end(), path_or_name) != names.end();
  std::error_code error;
  if (!is_known && std::filesystem::is_directory(path_or_name, error)) {
    throw base::InputError("suite " + path_or_name +
                           " is a folder; accepted: a suite file, or a name of `list suites`");
  }
  if (is_file_name(path_or_name)) {
    throw base::InputError("suite file " + path_or_name + " does not exist");
  }
  if (!is_known) {
    throw base::InputError(base::unknown_name("suite", path_or_name, names));
  }
  return catalog_folder() / (path_or_name + ".yaml");
}

}  // namespace suites

#pragma once

#include <filesystem>
#include <string>

namespace results::html_report {

/// Files that a page may load.
enum class Files { none, beside };

/// A whole offline page: head with title, policy and style sheet, the body, the script. The policy
/// makes "offline" a fact: the page can load nothing that is not inside it, or beside it if it is
/// split.
/// @param data  elements that only the script reads; last, so that the page is shown before them
std::string page_frame(const std::string& title, const std::string& body, Files files = Files::none,
                       const std::string& data = "");

/// Where the page of a run is or would be.
std::filesystem::path page_file(const std::filesystem::path& run_folder);

/// Writes <run>/report/index.html. @return its path
std::filesystem::path write_page(const std::filesystem::path& run_folder, const std::string& html);

}  // namespace results::html_report

#pragma once

#include <string_view>

namespace results::html_report {

/// The page's style sheet and script, embedded from the files of page/ at build time.
std::string_view style_sheet();
std::string_view script();

}  // namespace results::html_report

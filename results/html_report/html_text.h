#pragma once

#include <string>
#include <string_view>

#include "results/markup_text.h"

namespace results::html_report {

/// The attribute by which the page sorts a table cell: ` data-sort="1.5"`; infinity sorts last.
std::string sort_attribute(double value);

/// Base64 with padding (RFC 4648, Sec. 4).
std::string base64(std::string_view bytes);

}  // namespace results::html_report

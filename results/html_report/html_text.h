#pragma once

#include <string>
#include <string_view>

namespace results::html_report {

/// Text as HTML content or as a quoted attribute: & < > " ' become character references.
std::string escape(std::string_view text);

/// The attribute by which the page sorts a table cell: ` data-sort="1.5"`; infinity sorts last.
std::string sort_attribute(double value);

/// Base64 with padding (RFC 4648, Sec. 4).
std::string base64(std::string_view bytes);

}  // namespace results::html_report

#pragma once

#include <string>
#include <string_view>

namespace results {

/// Text as HTML or XML content or as a quoted attribute: & < > " ' become character references.
std::string escape(std::string_view text);

}  // namespace results

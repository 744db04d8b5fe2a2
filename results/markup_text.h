#pragma once

#include <string>
#include <string_view>

namespace results {

/// Text as HTML or XML content or as a quoted attribute: & < > " ' become character references;
/// characters that change the direction of text are spelled ("\u202e"), so that it reads as
/// written.
std::string escape(std::string_view text);

}  // namespace results

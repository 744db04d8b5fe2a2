#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Words about a picture inside its file, where programs that show files look for them.
namespace results::figures {

/// Name and text; of a PDF a name of its document information: Title, Subject, Creator, Keywords.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// Puts a <metadata> element after the opening tag, a line per text.
/// @param svg  the file's bytes @return false, and nothing changed, if it is no SVG
bool add_svg_metadata(std::string& svg, const Metadata& metadata);

/// Replaces the document information by an incremental update at the end.
/// Source: ISO 32000-1, Sec. 7.5.6 and 14.3.3.
/// @return false, and nothing changed, for what is no PDF with a cross-reference table
bool add_pdf_metadata(std::string& pdf, const Metadata& metadata);

/// Adds a textual chunk per entry (iTXt, UTF-8) after the header.
/// Source: PNG Specification (Third Edition), Sec. 11.3.3.4.
/// @return false, and nothing changed, if it is no PNG
bool add_png_metadata(std::string& png, const Metadata& metadata);

}  // namespace results::figures

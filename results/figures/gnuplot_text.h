#pragma once

#include <string>
#include <string_view>

namespace results::figures {

/// A text as a gnuplot string that shows exactly that text, as a title, label or name in a legend.
///
/// Single quotes: gnuplot neither runs `commands` nor expands @macros within them. The marks of its
/// enhanced text, \ ^ _ { } @ & ~, get a backslash; control characters become spaces.
std::string gnuplot_string(std::string_view text);
/// A text as a string that is no text of the figure, such as a path: marks stay as they are.
std::string gnuplot_plain_string(std::string_view text);
/// `gnuplot_string` for a label of a tic, which gnuplot also reads as a format: % is doubled.
std::string gnuplot_tic_string(std::string_view text);
/// `gnuplot_string` in bold.
std::string gnuplot_bold_string(std::string_view text);

/// A text as the rest of a comment line: no control characters, no backslash at its end.
std::string gnuplot_comment(std::string_view text);

/// Width of a text in the figures' font, roughly. @param font_pt  its size
double text_width_cm(std::string_view text, double font_pt);
/// The text, or its beginning and "..." if it is wider.
std::string shortened(std::string_view text, double width_cm, double font_pt);

}  // namespace results::figures

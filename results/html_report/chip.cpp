#include "results/html_report/chip.h"

#include <fmt/format.h>

#include "results/html_report/html_text.h"

namespace results::html_report {

std::string chip(const ChipLook& look, const std::string& text) {
  return fmt::format("<b class=\"verdict {}\">{} {}</b>", look.css, look.sign, escape(text));
}

}  // namespace results::html_report

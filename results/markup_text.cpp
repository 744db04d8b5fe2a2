#include "results/markup_text.h"

#include "perception/base/code_points.h"

namespace results {

std::string escape(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (const char c : base::with_spelled_directions(text)) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

}  // namespace results

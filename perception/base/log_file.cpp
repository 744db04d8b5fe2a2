#include "perception/base/log_file.h"

#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "perception/base/atomic_file.h"

namespace base {

void keep_first_and_last(const std::filesystem::path& path, std::int64_t bytes_each) {
  std::error_code error;
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(path, error));
  if (error || size <= 2 * bytes_each) return;
  const std::string text = read_text_file(path);
  const auto kept = static_cast<std::size_t>(bytes_each);
  const std::string_view all(text);
  write_text_file(path, fmt::format("{}\n[... {} bytes left out ...]\n{}", all.substr(0, kept),
                                    size - 2 * bytes_each, all.substr(all.size() - kept)));
}

}  // namespace base

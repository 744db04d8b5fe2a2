#pragma once

#include <cstdint>
#include <filesystem>

namespace base {

/// Shortens a log to its first and last `bytes_each` bytes with a line between them that says how
/// many were left out. A shorter file and a missing one stay as they are.
void keep_first_and_last(const std::filesystem::path& path, std::int64_t bytes_each);

}  // namespace base

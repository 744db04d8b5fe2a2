#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace base {

/// The whole file as text. @throws InputError if it cannot be read
std::string read_text_file(const std::filesystem::path& path);

/// Writes under a temporary name beside the target, then renames: readers see all or nothing.
/// @throws InputError with the system's reason (disk full, read-only, ...)
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// Same for a writer that needs a path: calls write(temporary path), then renames.
void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(const std::filesystem::path&)>& write);

}  // namespace base

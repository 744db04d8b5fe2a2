#pragma once

#include <filesystem>

namespace perception {

/// Looks at the lengths that the header of an EXR file states before OpenEXR makes room for them:
/// a text of "1.6 GB" in a file of 180 bytes took 3 GB of memory. Internal: `read_exr`.
///
/// What else may be wrong is left to OpenEXR.
/// @throws base::InputError for an attribute that is longer than what is left of the file
/// Source: OpenEXR File Layout, https://openexr.com/en/latest/OpenEXRFileLayout.html
void check_exr_header(const std::filesystem::path& path);

}  // namespace perception

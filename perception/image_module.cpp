#include "perception/image_module.h"

#include <dlfcn.h>

#include <cstdlib>
#include <memory>
#include <system_error>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/openimageio_module/module.h"

namespace perception {
namespace {

constexpr const char* kModuleFile = "discern_openimageio.so";

/// The module's functions; it stays loaded, opening it again costs microseconds.
struct Module {
  DiscernDecode decode = nullptr;
  DiscernEncode encode = nullptr;
  DiscernFree free = nullptr;
};

template <class Function>
Function symbol(void* library, const std::filesystem::path& path, const char* name) {
  void* found = dlsym(library, name);
  if (found == nullptr) {
    throw base::DeviceError(
        fmt::format("{}: not this program's module of image formats: it lacks "
                    "\"{}\"",
                    path.string(), name));
  }
  return reinterpret_cast<Function>(found);
}

Module open_module(std::span<const std::filesystem::path> folders) {
  std::string tried;
  for (const std::filesystem::path& folder : folders) {
    const std::filesystem::path path = folder / kModuleFile;
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
      tried += fmt::format("{}{}", tried.empty() ? "" : ", ", path.string());
      continue;
    }
    // Lazy: binding every symbol of its 261 libraries now would take a fifth longer.
    void* library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (library == nullptr) {
      throw base::DeviceError(fmt::format("{}: the module of image formats cannot be opened: {}",
                                          path.string(), dlerror()));
    }
    return {symbol<DiscernDecode>(library, path, "discern_decode_image"),
            symbol<DiscernEncode>(library, path, "discern_encode_image"),
            symbol<DiscernFree>(library, path, "discern_free")};
  }
  throw base::DeviceError(fmt::format(
      "the module of image formats (all but EXR and PFM) is missing; tried: {}; accepted "
      "also: its folder in $DISCERN_MODULE_DIR",
      tried));
}

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines{""};
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  return lines;
}

}  // namespace

std::vector<std::filesystem::path> image_module_folders() {
  std::vector<std::filesystem::path> folders;
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    folders.push_back(self.parent_path());
    folders.push_back(self.parent_path().parent_path() / "lib" / "discern");
  }
  const char* extra = std::getenv("DISCERN_MODULE_DIR");
  if (extra != nullptr && *extra != '\0') folders.emplace_back(extra);
  return folders;
}

ImageFile decode_with_module(std::span<const std::filesystem::path> folders,
                             const std::filesystem::path& path, std::optional<Encoding> encoding) {
  const Module module = open_module(folders);
  DiscernDecodedImage decoded{};
  DiscernReason reason{};
  if (module.decode(path.c_str(), &decoded, &reason) == 0) {
    throw base::InputError(
        fmt::format("{}: cannot be read as an image: {}", path.string(), reason.text));
  }
  const std::unique_ptr<float, DiscernFree> pixels(decoded.pixels, module.free);
  const std::unique_ptr<char, DiscernFree> names(decoded.channel_names, module.free);
  const Encoding usual = decoded.is_integer != 0 ? Encoding::display : Encoding::scene_linear;
  Image image(decoded.width_px, decoded.height_px, split_lines(names.get()),
              encoding.value_or(usual));
  image.pixels.assign(pixels.get(), pixels.get() + image.pixels.size());
  return {{{"", std::move(image)}}, {}};
}

std::string encode_with_module(std::span<const std::filesystem::path> folders,
                               const ByteImage& source) {
  const Module module = open_module(folders);
  const DiscernByteImage raw{source.width_px, source.height_px, source.channel_count,
                             source.pixels.data(), source.jpeg_quality};
  DiscernBytes bytes{};
  DiscernReason reason{};
  if (module.encode(&raw, &bytes, &reason) == 0) {
    throw base::DeviceError(fmt::format("a {}x{} {} cannot be encoded: {}", source.width_px,
                                        source.height_px, source.jpeg_quality > 0 ? "JPEG" : "PNG",
                                        reason.text));
  }
  const std::unique_ptr<unsigned char, DiscernFree> data(bytes.data, module.free);
  return {reinterpret_cast<const char*>(data.get()), bytes.size};
}

}  // namespace perception

#include "perception/openimageio_module/module.h"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace {

constexpr double kMax8Bit = 255.0;
constexpr double kMax16Bit = 65535.0;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;  ///< as for EXR files

template <class T>
T* allocate(std::size_t count) {
  void* memory = std::malloc(count * sizeof(T));
  if (memory == nullptr) throw std::bad_alloc();
  return static_cast<T*>(memory);
}

[[noreturn]] void fail(const OIIO::ImageInput* input) {
  const std::string text = input != nullptr ? input->geterror() : OIIO::geterror();
  throw std::runtime_error(text.empty() ? "no reason given" : text);
}

/// Reads as stored and divides here: OpenImageIO multiplies by a rounded 1/255 instead.
template <class T>
void read_integers(OIIO::ImageInput& input, OIIO::TypeDesc type, double max, std::size_t count,
                   float* pixels) {
  std::vector<T> values(count);
  if (!input.read_image(0, 0, 0, -1, type, values.data())) fail(&input);
  for (std::size_t i = 0; i < count; ++i) {
    pixels[i] = static_cast<float>(static_cast<double>(values[i]) / max);
  }
}

void read_pixels(OIIO::ImageInput& input, DiscernDecodedImage& image) {
  const OIIO::ImageSpec spec = input.spec();
  const auto count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                     static_cast<std::size_t>(spec.nchannels);
  image.pixels = allocate<float>(count);
  image.is_integer = 1;
  if (spec.format == OIIO::TypeDesc::UINT8) {
    read_integers<std::uint8_t>(input, OIIO::TypeDesc::UINT8, kMax8Bit, count, image.pixels);
  } else if (spec.format == OIIO::TypeDesc::UINT16) {
    read_integers<std::uint16_t>(input, OIIO::TypeDesc::UINT16, kMax16Bit, count, image.pixels);
  } else {
    image.is_integer = spec.format.is_floating_point() ? 0 : 1;
    if (!input.read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, image.pixels)) fail(&input);
  }
  // A damaged JPEG is read to its end with grey rows and a warning; that is an error to us.
  if (input.has_error()) fail(&input);
}

void decode(const char* path, DiscernDecodedImage& image) {
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // never premultiply
  wishes.attribute("oiio:RawColor", 1);           // never convert colour models
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &wishes);
  if (!input) fail(nullptr);
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 ||
      spec.width > kMaxPixels / spec.height) {
    throw std::runtime_error("its size is not that of a picture of 1 to 268435456 pixels");
  }
  image.width_px = spec.width;
  image.height_px = spec.height;
  image.channel_count = spec.nchannels;
  std::string names;
  for (const std::string& name : spec.channelnames) names += (names.empty() ? "" : "\n") + name;
  image.channel_names = allocate<char>(names.size() + 1);
  std::memcpy(image.channel_names, names.c_str(), names.size() + 1);
  read_pixels(*input, image);
}

void encode(const DiscernByteImage& source, DiscernBytes& bytes) {
  OIIO::ImageSpec spec(source.width_px, source.height_px, source.channel_count,
                       OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const bool is_jpeg = source.jpeg_quality > 0;
  if (is_jpeg) {
    spec.attribute("Compression", "jpeg:" + std::to_string(source.jpeg_quality));
    spec.attribute("jpeg:subsampling", "4:4:4");
  }
  const char* name = is_jpeg ? "memory.jpg" : "memory.png";
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name);
  if (!output) fail(nullptr);
  std::vector<unsigned char> buffer;
  OIIO::Filesystem::IOVecOutput stream(buffer);
  if (!output->set_ioproxy(&stream) || !output->open(name, spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, source.pixels) || !output->close()) {
    throw std::runtime_error(output->geterror());
  }
  bytes.data = allocate<unsigned char>(buffer.size());
  bytes.size = buffer.size();
  std::memcpy(bytes.data, buffer.data(), buffer.size());
}

void set_reason(DiscernReason& reason, const char* text) {
  std::strncpy(reason.text, text, sizeof(reason.text) - 1);
  reason.text[sizeof(reason.text) - 1] = '\0';
}

}  // namespace

int discern_decode_image(const char* path, DiscernDecodedImage* image, DiscernReason* reason) {
  *image = {};
  try {
    decode(path, *image);
    return 1;
  } catch (const std::exception& error) {
    std::free(image->pixels);
    std::free(image->channel_names);
    set_reason(*reason, error.what());
    return 0;
  }
}

int discern_encode_image(const DiscernByteImage* source, DiscernBytes* bytes,
                         DiscernReason* reason) {
  *bytes = {};
  try {
    encode(*source, *bytes);
    return 1;
  } catch (const std::exception& error) {
    std::free(bytes->data);
    set_reason(*reason, error.what());
    return 0;
  }
}

void discern_free(void* memory) { std::free(memory); }

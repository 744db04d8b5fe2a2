#include <algorithm>
#include <cstdint>
#include <cstring>
#include <set>

#include <fmt/format.h>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>

#include "perception/base/errors.h"
#include "perception/exr_file.h"

namespace perception {
namespace {

/// Collects the file in memory: its last bytes, the table of chunks, are written by a destructor
/// that swallows errors, which a full disk would make into a broken file without a word.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : OStream("image in memory") {}
  void write(const char bytes[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (bytes_.size() < position_ + size) bytes_.resize(position_ + size);
    std::memcpy(bytes_.data() + position_, bytes, size);
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

/// Numbers that OpenEXR's standard attributes hold as 32-bit floats (ImfStandardAttributes.h).
const std::set<std::string> kFloatAttributes{"whiteLuminance", "longitude", "latitude", "altitude",
                                             "utcOffset",      "expTime",   "aperture", "isoSpeed"};

void check_parts(const std::filesystem::path& name, const ImageFile& file) {
  const auto fail = [&name](const std::string& message) {
    throw base::InputError(fmt::format("{}: {}", name.string(), message));
  };
  if (file.parts.empty()) fail("an image file needs at least one image; none given");
  std::set<std::string> names;
  const Image& first = file.parts.front().image;
  for (const NamedImage& part : file.parts) {
    if (part.image.is_empty()) fail(fmt::format("the image \"{}\" is empty", part.name));
    if (!part.image.has_size_of(first)) {
      fail(fmt::format("the image \"{}\" has {}x{} pixels; accepted: {}x{}, as the first one",
                       part.name, part.image.width_px, part.image.height_px, first.width_px,
                       first.height_px));
    }
    const bool is_named = !part.name.empty() || file.parts.size() == 1;
    if (!is_named || !names.insert(part.name).second) {
      fail(fmt::format("two images or more need different names; found \"{}\" again or empty",
                       part.name));
    }
    const std::set<std::string> channels(part.image.channels.begin(), part.image.channels.end());
    if (channels.size() != part.image.channels.size() || channels.count("") != 0) {
      fail(fmt::format("the image \"{}\" has the channels {}; accepted: different, not empty",
                       part.name, fmt::join(part.image.channels, ", ")));
    }
  }
}

Imf::Header header_of(const NamedImage& part, const Attributes& attributes) {
  Imf::Header header(part.image.width_px, part.image.height_px);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.setType(Imf::SCANLINEIMAGE);
  if (!part.name.empty()) header.setName(part.name);
  for (const auto& [name, text] : attributes.text) {
    header.insert(name, Imf::StringAttribute(text));
  }
  for (const auto& [name, number] : attributes.number) {
    if (kFloatAttributes.count(name) != 0) {
      header.insert(name, Imf::FloatAttribute(static_cast<float>(number)));
    } else {
      header.insert(name, Imf::DoubleAttribute(number));
    }
  }
  // The image knows its encoding best, whatever the attributes say.
  header.insert(kEncodingAttribute, Imf::StringAttribute(to_string(part.image.encoding)));
  for (const std::string& channel : part.image.channels) {
    header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
  }
  return header;
}

void write_part(Imf::MultiPartOutputFile& output, int index, const Image& image) {
  const std::size_t x_stride = image.channels.size() * sizeof(float);
  const std::size_t y_stride = x_stride * static_cast<std::size_t>(image.width_px);
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    const auto* base = reinterpret_cast<const char*>(image.pixels.data() + c);
    buffer.insert(image.channels[c],
                  Imf::Slice(Imf::FLOAT, const_cast<char*>(base), x_stride, y_stride));
  }
  Imf::OutputPart part(output, index);
  part.setFrameBuffer(buffer);
  part.writePixels(image.height_px);
}

}  // namespace

std::string exr_bytes(const std::filesystem::path& name, const ImageFile& file) {
  check_parts(name, file);
  try {
    std::vector<Imf::Header> headers;
    for (const NamedImage& part : file.parts) headers.push_back(header_of(part, file.attributes));
    MemoryStream stream;
    {
      Imf::MultiPartOutputFile output(stream, headers.data(), static_cast<int>(headers.size()));
      for (std::size_t i = 0; i < file.parts.size(); ++i) {
        write_part(output, static_cast<int>(i), file.parts[i].image);
      }
    }
    return stream.take();
  } catch (const std::exception& error) {
    throw base::InputError(
        fmt::format("{}: cannot be written as EXR: {}", name.string(), error.what()));
  }
}

}  // namespace perception

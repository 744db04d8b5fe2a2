#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>

#include <fmt/format.h>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>

#include "perception/base/errors.h"
#include "perception/exr_file.h"
#include "perception/exr_header_check.h"

namespace perception {
namespace {

/// Largest window read, pixels (16384 x 16384): a damaged header must not ask for all memory.
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;

/// Header entries that describe the file's layout, not the picture.
const std::set<std::string> kLayoutAttributes{
    "name", "type", "version", "view", "chunkCount", "pixelAspectRatio", "screenWindowWidth"};

/// The channels of one layer: their names in the image, and in the file.
struct Layer {
  std::vector<std::string> channels;
  std::vector<std::string> file_channels;
};

/// R, G, B, A first, in this order; then by name.
bool is_channel_before(const std::string& a, const std::string& b) {
  constexpr std::string_view kOrder = "RGBArgba";
  const auto rank = [&kOrder](const std::string& name) {
    const std::size_t found = name.size() == 1 ? kOrder.find(name) : std::string_view::npos;
    return found == std::string_view::npos ? kOrder.size() : found % 4;
  };
  return rank(a) != rank(b) ? rank(a) < rank(b) : a < b;
}

/// The channels of a part by layer; the layer "" sorts first.
std::map<std::string, Layer> layers_of(const Imf::ChannelList& list) {
  std::map<std::string, std::vector<std::string>> names;
  for (auto channel = list.begin(); channel != list.end(); ++channel) {
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
      throw base::InputError(
          fmt::format("channel \"{}\" is stored at every {}x{} pixels; accepted: full resolution",
                      channel.name(), channel.channel().xSampling, channel.channel().ySampling));
    }
    const std::string name = channel.name();
    const std::size_t dot = name.rfind('.');
    const bool is_layered = dot != std::string::npos && dot > 0 && dot + 1 < name.size();
    names[is_layered ? name.substr(0, dot) : ""].push_back(is_layered ? name.substr(dot + 1)
                                                                      : name);
  }
  if (names.empty()) throw base::InputError("it has no channels");
  std::map<std::string, Layer> layers;
  for (auto& [layer, channels] : names) {
    std::sort(channels.begin(), channels.end(), is_channel_before);
    for (const std::string& channel : channels) {
      layers[layer].channels.push_back(channel);
      layers[layer].file_channels.push_back(layer.empty() ? channel : layer + "." + channel);
    }
  }
  return layers;
}

std::int64_t checked_pixels(const char* what, const Imath::Box2i& window) {
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width < 1 || height < 1 || width > kMaxPixels / height) {
    throw base::InputError(fmt::format("its {} has {}x{} pixels; accepted: 1 to {} in all", what,
                                       width, height, kMaxPixels));
  }
  return width * height;
}

Image image_for(const Imath::Box2i& window, const Layer& layer, Encoding encoding) {
  return Image(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, layer.channels,
               encoding);
}

/// The pixels of the data window, laid into the display window.
Image placed(const Image& stored, const Imath::Box2i& data, const Imath::Box2i& display) {
  Image image(display.max.x - display.min.x + 1, display.max.y - display.min.y + 1, stored.channels,
              stored.encoding);
  const int left = std::max(data.min.x, display.min.x);
  const int right = std::min(data.max.x, display.max.x);
  if (left > right) return image;
  const auto count = static_cast<std::size_t>(right - left + 1) * stored.channels.size();
  for (int y = std::max(data.min.y, display.min.y); y <= std::min(data.max.y, display.max.y); ++y) {
    const float* from = stored.pixels.data() + stored.offset(left - data.min.x, y - data.min.y);
    std::copy_n(from, count,
                image.pixels.data() + image.offset(left - display.min.x, y - display.min.y));
  }
  return image;
}

void insert_slices(Imf::FrameBuffer& buffer, Image& image, const Layer& layer,
                   const Imath::Box2i& data) {
  const std::size_t x_stride = image.channels.size() * sizeof(float);
  const std::size_t y_stride = x_stride * static_cast<std::size_t>(image.width_px);
  for (std::size_t c = 0; c < layer.file_channels.size(); ++c) {
    buffer.insert(layer.file_channels[c],
                  Imf::Slice::Make(Imf::FLOAT, image.pixels.data() + c, data, x_stride, y_stride));
  }
}

Attributes attributes_of(const Imf::Header& header) {
  Attributes attributes;
  for (auto entry = header.begin(); entry != header.end(); ++entry) {
    const std::string name = entry.name();
    if (kLayoutAttributes.count(name) != 0) continue;
    const Imf::Attribute& attribute = entry.attribute();
    const std::string type = attribute.typeName();
    if (type == Imf::StringAttribute::staticTypeName()) {
      attributes.text[name] = static_cast<const Imf::StringAttribute&>(attribute).value();
    } else if (type == Imf::FloatAttribute::staticTypeName()) {
      attributes.number[name] = static_cast<const Imf::FloatAttribute&>(attribute).value();
    } else if (type == Imf::DoubleAttribute::staticTypeName()) {
      attributes.number[name] = static_cast<const Imf::DoubleAttribute&>(attribute).value();
    } else if (type == Imf::IntAttribute::staticTypeName()) {
      attributes.number[name] = static_cast<const Imf::IntAttribute&>(attribute).value();
    }
  }
  return attributes;
}

Encoding encoding_of(const Imf::Header& header, std::optional<Encoding> wanted) {
  if (wanted) return *wanted;
  const auto* stored = header.findTypedAttribute<Imf::StringAttribute>(kEncodingAttribute);
  return stored != nullptr ? encoding_from_text(stored->value()) : Encoding::scene_linear;
}

/// A name for a layer of a part, unique in the file.
std::string part_name(const Imf::Header& header, const std::string& layer) {
  const std::string part = header.hasName() ? header.name() : "";
  if (part.empty() || layer.empty()) return part + layer;
  return part == layer ? part : part + "." + layer;
}

void read_part(Imf::MultiPartInputFile& input, int index, std::optional<Encoding> encoding,
               std::vector<NamedImage>& parts) {
  const Imf::Header& header = input.header(index);
  if (header.hasType() && Imf::isDeepData(header.type())) {
    throw base::InputError("it holds deep data; accepted: scan lines or tiles");
  }
  if (!input.partComplete(index)) throw base::InputError("the file is incomplete");
  const Imath::Box2i data = header.dataWindow();
  const Imath::Box2i display = header.displayWindow();
  checked_pixels("data window", data);
  checked_pixels("display window", display);

  std::vector<Image> images;
  Imf::FrameBuffer buffer;
  const std::map<std::string, Layer> layers = layers_of(header.channels());
  images.reserve(layers.size());
  for (const auto& [name, layer] : layers) {
    images.push_back(image_for(data, layer, encoding_of(header, encoding)));
    insert_slices(buffer, images.back(), layer, data);
  }
  Imf::InputPart part(input, index);
  part.setFrameBuffer(buffer);
  part.readPixels(data.min.y, data.max.y);

  std::size_t i = 0;
  for (const auto& [name, layer] : layers) {
    Image& stored = images[i++];
    parts.push_back({part_name(header, name),
                     data == display ? std::move(stored) : placed(stored, data, display)});
  }
}

}  // namespace

ImageFile read_exr(const std::filesystem::path& path, std::optional<Encoding> encoding) {
  try {
    check_exr_header(path);
    // One thread: the pool of OpenEXR is not ours to size.
    Imf::MultiPartInputFile input(path.c_str(), 0);
    ImageFile file;
    file.attributes = attributes_of(input.header(0));
    for (int i = 0; i < input.parts(); ++i) read_part(input, i, encoding, file.parts);
    return file;
  } catch (const std::exception& error) {
    throw base::InputError(
        fmt::format("{}: cannot be read as EXR: {}", path.string(), error.what()));
  }
}

}  // namespace perception

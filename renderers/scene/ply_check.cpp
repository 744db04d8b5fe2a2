#include "renderers/scene/ply_check.h"

#include "perception/base/errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <vector>

namespace renderers::scene {
namespace {

struct Property {
  std::string type;
  std::string count_type;  ///< of a list; empty: a single value
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

enum class PlyFormat { ascii, little_endian, big_endian };

struct Header {
  PlyFormat format = PlyFormat::ascii;
  std::vector<Element> elements;
  std::size_t data_offset = 0;
};

[[noreturn]] void fail(const std::string& file, const std::string& message) {
  throw base::InputError(fmt::format("{}: {}", file, message));
}

std::size_t byte_count(const std::string& type, const std::string& file) {
  const auto is_one_of = [&](std::initializer_list<const char*> names) {
    return std::ranges::any_of(names, [&](const char* name) { return type == name; });
  };
  if (is_one_of({"char", "uchar", "int8", "uint8"})) return 1;
  if (is_one_of({"short", "ushort", "int16", "uint16"})) return 2;
  if (is_one_of({"int", "uint", "float", "int32", "uint32", "float32"})) return 4;
  if (is_one_of({"double", "float64"})) return 8;
  fail(file, fmt::format("unknown PLY type \"{}\"; known: char, uchar, short, ushort, int, uint, "
                         "float, double, and int8 to float64",
                         type));
}

PlyFormat read_format(const std::string& name, const std::string& file) {
  if (name == "ascii") return PlyFormat::ascii;
  if (name == "binary_little_endian") return PlyFormat::little_endian;
  if (name == "binary_big_endian") return PlyFormat::big_endian;
  fail(file, fmt::format("unknown PLY format \"{}\"; known: ascii, binary_little_endian, "
                         "binary_big_endian",
                         name));
}

void read_header_line(const std::string& line, Header& header, const std::string& file) {
  std::istringstream words(line);
  std::string key;
  words >> key;
  if (key == "format") {
    std::string name;
    words >> name;
    header.format = read_format(name, file);
  } else if (key == "element") {
    Element element;
    words >> element.name >> element.count;
    if (!words) {
      fail(file,
           fmt::format("cannot read the header line \"{}\"; accepted: element NAME COUNT", line));
    }
    const bool is_known = std::ranges::any_of(
        header.elements, [&](const Element& other) { return other.name == element.name; });
    if (is_known)
      fail(file, fmt::format("element {} is listed twice; accepted: once", element.name));
    header.elements.push_back(element);
  } else if (key == "property") {
    if (header.elements.empty()) fail(file, "a property comes before the first element");
    Property property;
    words >> property.type;
    if (property.type == "list") {
      words >> property.count_type >> property.type;
      byte_count(property.count_type, file);
    }
    byte_count(property.type, file);  // also of text: a type that nobody knows
    header.elements.back().properties.push_back(property);
  } else if (key != "ply" && key != "comment" && key != "obj_info" && !key.empty()) {
    fail(file, fmt::format("cannot read the header line \"{}\"; accepted: format, element, "
                           "property, comment, obj_info",
                           line));
  }
}

Header read_header(std::string_view data, const std::string& file) {
  if (!data.starts_with("ply")) fail(file, "not a PLY file: it must begin with ply");
  Header header;
  for (std::size_t begin = 0; begin < data.size();) {
    const std::size_t end = data.find('\n', begin);
    if (end == std::string_view::npos) break;
    std::string line(data.substr(begin, end - begin));
    if (line.ends_with('\r')) line.pop_back();
    begin = end + 1;
    if (line == "end_header") {
      header.data_offset = begin;
      return header;
    }
    read_header_line(line, header, file);
  }
  fail(file, "truncated: the PLY header has no end_header");
}

/// Reads the values after the header one by one, text or binary.
class DataReader {
 public:
  DataReader(std::string_view data, PlyFormat format, const std::string& file)
      : data_(data), format_(format), file_(file) {}

  /// The next value. @throws base::InputError if the data end before it, or it is not finite
  double next(const std::string& type, const Element& element, std::size_t index) {
    const double value =
        format_ == PlyFormat::ascii ? next_word(element, index) : next_bytes(type, element, index);
    if (!std::isfinite(value)) fail_at(element, index, "has a value that is not finite");
    return value;
  }

  /// "mesh.ply: face 3 <message>"
  [[noreturn]] void fail_at(const Element& element, std::size_t index,
                            const std::string& message) const {
    fail(file_, fmt::format("{} {} {}", element.name, index, message));
  }

 private:
  double next_word(const Element& element, std::size_t index) {
    constexpr std::string_view kSpace = " \t\r\n";
    const std::size_t begin = data_.find_first_not_of(kSpace, at_);
    if (begin == std::string_view::npos) fail_truncated(element, index);
    at_ = std::min(data_.find_first_of(kSpace, begin), data_.size());
    double value = 0.0;
    const auto result = std::from_chars(data_.data() + begin, data_.data() + at_, value);
    if (result.ec != std::errc() || result.ptr != data_.data() + at_) {
      fail_at(element, index,
              fmt::format("has \"{}\" instead of a number", data_.substr(begin, at_ - begin)));
    }
    return value;
  }

  double next_bytes(const std::string& type, const Element& element, std::size_t index) {
    const std::size_t size = byte_count(type, file_);
    if (data_.size() - at_ < size) fail_truncated(element, index);
    char bytes[8] = {};
    std::memcpy(bytes, data_.data() + at_, size);
    at_ += size;
    if (format_ == PlyFormat::big_endian) std::reverse(bytes, bytes + size);
    return decoded(type, bytes);
  }

  template <typename T>
  static double as(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return static_cast<double>(value);
  }

  static double decoded(const std::string& type, const char* bytes) {
    static_assert(std::endian::native == std::endian::little);
    if (type == "float" || type == "float32") return as<float>(bytes);
    if (type == "double" || type == "float64") return as<double>(bytes);
    if (type == "char" || type == "int8") return as<std::int8_t>(bytes);
    if (type == "uchar" || type == "uint8") return as<std::uint8_t>(bytes);
    if (type == "short" || type == "int16") return as<std::int16_t>(bytes);
    if (type == "ushort" || type == "uint16") return as<std::uint16_t>(bytes);
    if (type == "uint" || type == "uint32") return as<std::uint32_t>(bytes);
    return as<std::int32_t>(bytes);
  }

  [[noreturn]] void fail_truncated(const Element& element, std::size_t index) const {
    fail(file_,
         fmt::format("truncated: the data end at {} {} of {}", element.name, index, element.count));
  }

  std::string_view data_;
  PlyFormat format_;
  const std::string& file_;
  std::size_t at_ = 0;
};

/// Number of vertices of the header, 0 without such an element.
std::size_t vertex_count(const Header& header) {
  for (const Element& element : header.elements) {
    if (element.name == "vertex") return element.count;
  }
  return 0;
}

/// One face's index list. @return triangles of its fan
std::size_t check_index_list(DataReader& reader, const Property& property, const Element& element,
                             std::size_t index, std::vector<bool>& is_used) {
  const double length = reader.next(property.count_type, element, index);
  if (length < 3) reader.fail_at(element, index, fmt::format("has {} corners; at least 3", length));
  for (double i = 0; i < length; ++i) {
    const double vertex = reader.next(property.type, element, index);
    if (vertex < 0 || vertex >= static_cast<double>(is_used.size())) {
      reader.fail_at(element, index,
                     fmt::format("names vertex {}; the file has {}", vertex, is_used.size()));
    }
    is_used[static_cast<std::size_t>(vertex)] = true;
  }
  return static_cast<std::size_t>(length) - 2;
}

}  // namespace

MeshFileCounts check_ply(std::string_view data, const std::string& file) {
  const Header header = read_header(data, file);
  std::vector<bool> is_used(vertex_count(header), false);
  DataReader reader(data.substr(header.data_offset), header.format, file);
  std::size_t triangles = 0;
  for (const Element& element : header.elements) {
    for (std::size_t index = 0; index < element.count; ++index) {
      bool is_first_list = element.name == "face";
      for (const Property& property : element.properties) {
        if (property.count_type.empty()) {
          reader.next(property.type, element, index);
        } else if (is_first_list) {
          triangles += check_index_list(reader, property, element, index, is_used);
          is_first_list = false;
        } else {
          const double length = reader.next(property.count_type, element, index);
          for (double i = 0; i < length; ++i) reader.next(property.type, element, index);
        }
      }
    }
  }
  if (triangles == 0) fail(file, "has no faces");
  return {triangles, static_cast<std::size_t>(std::ranges::count(is_used, false))};
}

}  // namespace renderers::scene

#include "perception/exr_file.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <Imath/half.h>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "tests/expect_error.h"
#include "tests/temporary_folder.h"

namespace perception {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Image wavy(int width_px, int height_px, std::vector<std::string> channels,
           Encoding encoding = Encoding::scene_linear) {
  Image image(width_px, height_px, std::move(channels), encoding);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = std::sin(static_cast<float>(i) * 0.37F) * 100.0F;
  }
  return image;
}

ImageFile three_parts() {
  ImageFile file;
  file.parts = {{"radiance", wavy(33, 21, {"R", "G", "B"})},
                {"albedo", wavy(33, 21, {"R", "G", "B", "A"}, Encoding::display)},
                {"depth", wavy(33, 21, {"Z"}, Encoding::luminance_cd_m2)}};
  Image& radiance = file.parts[0].image;
  radiance.pixels[0] = kNan;
  radiance.pixels[1] = kInfinity;
  radiance.pixels[2] = -kInfinity;
  radiance.pixels[3] = -0.0F;
  radiance.pixels[4] = std::numeric_limits<float>::denorm_min();
  radiance.pixels[5] = std::numeric_limits<float>::max();
  file.attributes.text = {{"discern:scene", "Cornell \"Box\"\nline 2 \xc3\xa9"}, {"owner", ""}};
  file.attributes.number = {{"discern:luminance_scale_cd_m2", 0.1}, {"whiteLuminance", 203.0}};
  return file;
}

/// Equal bits, with every NaN equal to every other.
void expect_same_values(const Image& a, const Image& b) {
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (std::isnan(a.pixels[i]) && std::isnan(b.pixels[i])) continue;
    ASSERT_EQ(std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(float)), 0) << "value " << i;
  }
}

class ExrFile : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name = "x.exr") const {
    return folder_.path() / name;
  }
  ImageFile read() const { return read_image_file(path()); }
  tests::TemporaryFolder folder_;
};

TEST_F(ExrFile, PartsValuesAndAttributesComeBackExactly) {
  const ImageFile written = three_parts();
  write_exr(path(), written);
  const ImageFile back = read();
  ASSERT_EQ(back.parts.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.parts[i].name, written.parts[i].name);
    EXPECT_EQ(back.parts[i].image.channels, written.parts[i].image.channels);
    EXPECT_EQ(back.parts[i].image.encoding, written.parts[i].image.encoding);
    EXPECT_TRUE(back.parts[i].image.has_size_of(written.parts[i].image));
    expect_same_values(back.parts[i].image, written.parts[i].image);
  }
  auto text = written.attributes.text;
  text[kEncodingAttribute] = "scene_linear";  // every file says its encoding
  EXPECT_EQ(back.attributes.text, text);
  EXPECT_EQ(back.attributes.number, written.attributes.number);
}

TEST_F(ExrFile, OnePartMayBeUnnamed) {
  write_exr(path(), {{{"", wavy(5, 4, {"Y"})}}, {}});
  EXPECT_EQ(read().parts.front().name, "");
  write_exr(path(), {{{"variance", wavy(5, 4, {"Y"})}}, {}});
  EXPECT_EQ(read().parts.front().name, "variance");
}

TEST_F(ExrFile, TheImagesEncodingWinsOverTheAttributeAndTheReaderOverBoth) {
  ImageFile file{{{"", wavy(3, 3, {"Y"}, Encoding::luminance_cd_m2)}}, {}};
  file.attributes.text[kEncodingAttribute] = "display";
  write_exr(path(), file);
  EXPECT_EQ(read_image(path()).encoding, Encoding::luminance_cd_m2);
  EXPECT_EQ(read_image(path(), Encoding::display).encoding, Encoding::display);
}

TEST_F(ExrFile, IsTheSameBytesEveryTimeAndAfterReading) {
  const std::string bytes = exr_bytes("x.exr", three_parts());
  EXPECT_EQ(exr_bytes("y.exr", three_parts()), bytes);
  write_exr(path(), three_parts());
  EXPECT_EQ(base::read_text_file(path()), bytes);
  EXPECT_EQ(exr_bytes("z.exr", read()), bytes);
}

TEST_F(ExrFile, LeavesNoTemporaryFile) {
  write_exr(path(), three_parts());
  write_exr(path(), three_parts());
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    EXPECT_EQ(entry.path().filename(), "x.exr");
    ++files;
  }
  EXPECT_EQ(files, 1);
}

TEST_F(ExrFile, RefusesToWriteWhatCannotBeReadBack) {
  const auto write = [&](ImageFile file) { write_exr(path(), file); };
  const std::string start = path().string() + ": ";
  tests::expect_error<base::InputError>(
      [&] { write({}); }, start + "an image file needs at least one image; none given");
  tests::expect_error<base::InputError>(
      [&] {
        write({{{"a", wavy(4, 4, {"Y"})}, {"b", wavy(4, 5, {"Y"})}}, {}});
      },
      start + "the image \"b\" has 4x5 pixels; accepted: 4x4, as the first one");
  tests::expect_error<base::InputError>(
      [&] {
        write({{{"a", wavy(4, 4, {"Y"})}, {"a", wavy(4, 4, {"Y"})}}, {}});
      },
      start + "two images or more need different names; found \"a\" again or empty");
  EXPECT_THROW(write({{{"a", wavy(4, 4, {"Y", "Y"})}}, {}}), base::InputError);
  EXPECT_THROW(write({{{"a", Image()}}, {}}), base::InputError);
  EXPECT_FALSE(std::filesystem::exists(path()));
  tests::expect_error_with<base::InputError>(
      [&] { write_exr(path("none/x.exr"), three_parts()); },
      {path("none/x.exr").string(), "cannot be written", "No such file or directory"});
}

TEST_F(ExrFile, EveryTruncationIsAnErrorWithThePath) {
  write_exr(path(), three_parts());
  const std::string bytes = base::read_text_file(path());
  for (const double part : {0.001, 0.01, 0.1, 0.3, 0.5, 0.8, 0.95, 0.999}) {
    const auto size = static_cast<std::size_t>(static_cast<double>(bytes.size()) * part);
    base::write_text_file(path("cut.exr"), bytes.substr(0, size));
    tests::expect_error_with<base::InputError>([&] { read_image_file(path("cut.exr")); },
                                               {path("cut.exr").string(), "cannot be read as"});
  }
  base::write_text_file(path("cut.exr"), bytes.substr(0, bytes.size() - 1));
  EXPECT_THROW(read_image_file(path("cut.exr")), base::InputError);
}

TEST_F(ExrFile, DamagedBytesNeverCrash) {
  write_exr(path(), three_parts());
  const std::string bytes = base::read_text_file(path());
  for (std::size_t i = 4; i < bytes.size(); i += bytes.size() / 150) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    base::write_text_file(path("bad.exr"), damaged);
    try {
      read_image_file(path("bad.exr"));  // a flipped value in an attribute may well be readable
    } catch (const base::InputError& error) {
      EXPECT_NE(std::string(error.what()).find("bad.exr"), std::string::npos);
    }
  }
}

/// Files of other programs, written with OpenEXR itself.
class ForeignExr : public ExrFile {
 protected:
  template <class Value>
  void write_channels(const Imf::Header& start, Imf::PixelType type,
                      const std::vector<std::string>& channels, const std::vector<Value>& values) {
    Imf::Header header = start;
    const Imath::Box2i window = header.dataWindow();
    const int width = window.max.x - window.min.x + 1;
    const int height = window.max.y - window.min.y + 1;
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      header.channels().insert(channels[c], Imf::Channel(type));
      buffer.insert(
          channels[c],
          Imf::Slice::Make(type, values.data() + c, window, sizeof(Value) * channels.size(),
                           sizeof(Value) * channels.size() * static_cast<std::size_t>(width)));
    }
    Imf::OutputFile output(path().c_str(), header);
    output.setFrameBuffer(buffer);
    output.writePixels(height);
  }
};

TEST_F(ForeignExr, HalfAndUnsignedBecomeFloat) {
  write_channels<half>(Imf::Header(2, 1), Imf::HALF, {"Y"}, {half(0.5F), half(65504.0F)});
  EXPECT_EQ(read_image(path()).pixels, (std::vector<float>{0.5F, 65504.0F}));
  write_channels<unsigned>(Imf::Header(2, 1), Imf::UINT, {"id"}, {7U, 1U << 24});
  EXPECT_EQ(read_image(path()).pixels, (std::vector<float>{7.0F, 16777216.0F}));
  EXPECT_EQ(read_image(path()).encoding, Encoding::scene_linear);
}

TEST_F(ForeignExr, LayersBecomePartsTheUnnamedFirst) {
  write_channels<float>(Imf::Header(1, 1), Imf::FLOAT,
                        {"Z", "R", "albedo.G", "B", "albedo.R", "albedo.B", "a.b.N", "G", "A"},
                        {1, 2, 3, 4, 5, 6, 7, 8, 9});
  const ImageFile file = read();
  ASSERT_EQ(file.parts.size(), 3U);
  EXPECT_EQ(file.parts[0].name, "");
  EXPECT_EQ(file.parts[0].image.channels, (std::vector<std::string>{"R", "G", "B", "A", "Z"}));
  EXPECT_EQ(file.parts[0].image.pixels, (std::vector<float>{2, 8, 4, 9, 1}));
  EXPECT_EQ(file.parts[1].name, "a.b");
  EXPECT_EQ(file.parts[1].image.pixels, std::vector<float>{7});
  EXPECT_EQ(file.parts[2].name, "albedo");
  EXPECT_EQ(file.parts[2].image.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(file.parts[2].image.pixels, (std::vector<float>{5, 3, 6}));
}

TEST_F(ForeignExr, ADataWindowInsideTheDisplayWindowIsPaddedWithZero) {
  const Imf::Header header(Imath::Box2i({0, 0}, {3, 2}), Imath::Box2i({1, 1}, {2, 1}));
  write_channels<float>(header, Imf::FLOAT, {"Y"}, {5, 6});
  const Image image = read_image(path());
  EXPECT_EQ(image.width_px, 4);
  EXPECT_EQ(image.height_px, 3);
  EXPECT_EQ(image.pixels, (std::vector<float>{0, 0, 0, 0, 0, 5, 6, 0, 0, 0, 0, 0}));
}

TEST_F(ForeignExr, ADataWindowBeyondTheDisplayWindowIsCut) {
  const Imf::Header header(Imath::Box2i({10, 20}, {11, 20}), Imath::Box2i({9, 19}, {12, 20}));
  write_channels<float>(header, Imf::FLOAT, {"Y"}, {1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_EQ(read_image(path()).pixels, (std::vector<float>{6, 7}));
  const Imf::Header apart(Imath::Box2i({0, 0}, {1, 0}), Imath::Box2i({5, 5}, {6, 5}));
  write_channels<float>(apart, Imf::FLOAT, {"Y"}, {1, 2});
  EXPECT_EQ(read_image(path()).pixels, (std::vector<float>{0, 0}));
}

TEST_F(ForeignExr, TilesAreRead) {
  Imf::Header header(5, 3);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  header.setTileDescription(Imf::TileDescription(2, 2, Imf::ONE_LEVEL));
  const Image wave = wavy(5, 3, {"Y"});
  {
    Imf::TiledOutputFile output(path().c_str(), header);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, wave.pixels.data(), header.dataWindow()));
    output.setFrameBuffer(buffer);
    output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
  }
  EXPECT_EQ(read_image(path()).pixels, wave.pixels);
}

TEST_F(ForeignExr, OtherAttributesAreKeptApartByKind) {
  Imf::Header header(1, 1);
  header.insert("renderer", Imf::StringAttribute("other"));
  header.insert("samples", Imf::IntAttribute(64));
  write_channels<float>(header, Imf::FLOAT, {"Y"}, {1});
  const Attributes attributes = read().attributes;
  EXPECT_EQ(attributes.text, (std::map<std::string, std::string>{{"renderer", "other"}}));
  EXPECT_EQ(attributes.number, (std::map<std::string, double>{{"samples", 64.0}}));
}

TEST_F(ForeignExr, AnUnknownEncodingIsNamed) {
  Imf::Header header(1, 1);
  header.insert(kEncodingAttribute, Imf::StringAttribute("sRGB"));
  write_channels<float>(header, Imf::FLOAT, {"Y"}, {1});
  tests::expect_error<base::InputError>([&] { read(); },
                                        path().string() +
                                            ": cannot be read as EXR: unknown encoding \"sRGB\"; "
                                            "known: scene_linear, luminance_cd_m2, display");
}

TEST_F(ForeignExr, SubsampledChannelsAreRefused) {
  Imf::Header header(4, 4);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  header.channels().insert("RY", Imf::Channel(Imf::FLOAT, 2, 2));
  const std::vector<float> values(16);
  {
    Imf::OutputFile output(path().c_str(), header);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow()));
    buffer.insert("RY",
                  Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow(), 0, 0, 2, 2));
    output.setFrameBuffer(buffer);
    output.writePixels(4);
  }
  tests::expect_error<base::InputError>(
      [&] { read(); }, path().string() +
                           ": cannot be read as EXR: channel \"RY\" is stored at every "
                           "2x2 pixels; accepted: full resolution");
}

}  // namespace
}  // namespace perception

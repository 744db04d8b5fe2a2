#include "perception/image_file.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "tests/expect_error.h"
#include "tests/expect_input_error.h"
#include "tests/temporary_folder.h"

namespace perception {
namespace {

/// Every 8-bit value once, in each of the channels.
Image ramp(std::vector<std::string> channels) {
  Image image(16, 16, std::move(channels), Encoding::display);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = static_cast<float>(i / image.channels.size() % 256) / 255.0F;
  }
  return image;
}

/// An 8x8 baseline JPEG of the one grey 128, as hexadecimal digits.
constexpr const char* kGreyJpeg =
    "ffd8ffe000104a46494600010100000100010000ffe1001645786966000049492a0008000000000000000000"
    "ffdb004300020101010101020101010202020202040302020202050404030406050606060506060607090806"
    "0709070606080b08090a0a0a0a0a06080b0c0b0a0c090a0a0affc0000b080008000801011100ffc4001f0000"
    "010501010101010100000000000000000102030405060708090a0bffc400b510000201030302040305050404"
    "0000017d01020300041105122131410613516107227114328191a1082342b1c11552d1f02433627282090a16"
    "1718191a25262728292a3435363738393a434445464748494a535455565758595a636465666768696a737475"
    "767778797a838485868788898a92939495969798999aa2a3a4a5a6a7a8a9aab2b3b4b5b6b7b8b9bac2c3c4c5"
    "c6c7c8c9cad2d3d4d5d6d7d8d9dae1e2e3e4e5e6e7e8e9eaf1f2f3f4f5f6f7f8f9faffda0008010100003f00"
    "2bffd9";

std::string bytes_from_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  return bytes;
}

std::string little_endian(std::uint32_t value, int size) {
  std::string bytes;
  for (int i = 0; i < size; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xffU);
  return bytes;
}

/// A little-endian TIFF of one uncompressed grey row; the numbers are its tags.
std::string grey_tiff(std::uint32_t bits, std::uint32_t sample_format, const std::string& row) {
  constexpr std::uint32_t kShort = 3;
  constexpr std::uint32_t kEntries = 10;
  constexpr std::uint32_t kStart = 8 + 2 + 12 * kEntries + 4;
  const auto size = static_cast<std::uint32_t>(row.size());
  const std::uint32_t entries[kEntries][2]{
      {256, size * 8 / bits}, {257, 1}, {258, bits}, {259, 1},    {262, 1},
      {273, kStart},          {277, 1}, {278, 1},    {279, size}, {339, sample_format}};
  std::string bytes = "II*" + std::string(1, '\0') + little_endian(8, 4);
  bytes += little_endian(kEntries, 2);
  for (const auto& entry : entries) {
    bytes += little_endian(entry[0], 2) + little_endian(kShort, 2) + little_endian(1, 4) +
             little_endian(entry[1], 4);
  }
  return bytes + little_endian(0, 4) + row;
}

class ImageFiles : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  std::string put(const std::string& name, const std::string& bytes) const {
    base::write_text_file(path(name), bytes);
    return path(name).string();
  }
  tests::TemporaryFolder folder_;
};

TEST_F(ImageFiles, PngKeepsEvery8BitValueExactly) {
  for (const auto& channels :
       {std::vector<std::string>{"Y"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}) {
    const Image image = ramp(channels);
    write_png(path("x.png"), image);
    const Image back = read_image(path("x.png"));
    EXPECT_EQ(back.encoding, Encoding::display);
    EXPECT_EQ(back.channels, channels);
    EXPECT_EQ(back.pixels, image.pixels);  // v / 255 to the last bit, alpha not multiplied in
  }
}

TEST_F(ImageFiles, PngColorsUnderAlphaStay) {
  Image image(2, 1, {"R", "G", "B", "A"}, Encoding::display);
  image.pixels = {1, 0.2F, 0.4F, 0, 0.6F, 0.8F, 0, 0.2F};
  write_png(path("x.png"), image);
  const Image back = read_image(path("x.png"));
  for (std::size_t i = 0; i < 8; ++i) EXPECT_FLOAT_EQ(back.pixels[i], image.pixels[i]);
}

TEST_F(ImageFiles, PngBytesAreTheSameEveryTimeAndInTheFile) {
  const std::string bytes = png_bytes(ramp({"R", "G", "B"}));
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(png_bytes(ramp({"R", "G", "B"})), bytes);
  write_png(path("x.png"), ramp({"R", "G", "B"}));
  EXPECT_EQ(base::read_text_file(path("x.png")), bytes);
  EXPECT_EQ(bytes.find("tIME"), std::string::npos);  // no date inside
  EXPECT_NE(bytes.find("sRGB"), std::string::npos);
}

TEST_F(ImageFiles, PngRoundsToNearestAndClips) {
  Image image = make_gray_image(5, 1, "Y", Encoding::display);
  image.pixels = {-1.0F, 2.0F, 0.5F, std::numeric_limits<float>::quiet_NaN(),
                  std::numeric_limits<float>::infinity()};
  write_png(path("x.png"), image);
  EXPECT_EQ(read_image(path("x.png")).pixels,
            (std::vector<float>{0.0F, 1.0F, 128.0F / 255.0F, 0.0F, 1.0F}));
}

TEST_F(ImageFiles, JpegKeepsSmoothColoursAndIsSmallerWhereItMay) {
  Image image = make_rgb_image(32, 32, Encoding::display);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      image.at(x, y, 0) = static_cast<float>(x) / 31.0F;
      image.at(x, y, 1) = static_cast<float>(y) / 31.0F;
      image.at(x, y, 2) = 0.25F;
    }
  }
  const std::string bytes = jpeg_bytes(image, 90);
  EXPECT_EQ(bytes.substr(0, 3), "\xff\xd8\xff");
  EXPECT_EQ(jpeg_bytes(image, 90), bytes);
  EXPECT_LT(jpeg_bytes(image, 30).size(), bytes.size());
  const Image back = read_image(put("x.jpg", bytes));
  ASSERT_EQ(back.channel_count(), 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    EXPECT_NEAR(back.pixels[i], image.pixels[i], 0.04) << i;
  }
  const auto refused = [](const Image& refused_image, int quality) {
    return tests::input_error_of([&] { jpeg_bytes(refused_image, quality); });
  };
  EXPECT_EQ(refused(Image(1, 1, {"R", "G", "B", "A"}, Encoding::display), 90),
            "a JPEG cannot hold an image of 4 channels with the encoding display; accepted: 1 or 3 "
            "channels, display");
  EXPECT_EQ(refused(make_rgb_image(1, 1, Encoding::scene_linear), 90),
            "a JPEG cannot hold an image of 3 channels with the encoding scene_linear; accepted: "
            "1 or 3 channels, display");
  EXPECT_EQ(refused(make_rgb_image(1, 1, Encoding::display), 0),
            "JPEG quality 0; accepted: 1 to 100");
}

TEST_F(ImageFiles, PngRefusesOtherImages) {
  tests::expect_error<base::InputError>(
      [&] { write_png(path("x.png"), make_rgb_image(1, 1, Encoding::scene_linear)); },
      "a PNG cannot hold an image of 3 channels with the encoding scene_linear; accepted: 1, 3 or "
      "4 "
      "channels, display");
  EXPECT_THROW(png_bytes(Image(1, 1, {"R", "G"}, Encoding::display)), base::InputError);
  EXPECT_FALSE(std::filesystem::exists(path("x.png")));
}

TEST_F(ImageFiles, RadianceHdrIsSceneLinear) {
  // One RGBE pixel: mantissas 128, 64, 32 at exponent 129 + 8: value = m 2^(e - 136).
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
  put("x.hdr", head + std::string("\x80\x40\x20\x89\x80\x80\x80\x81", 8));
  const Image image = read_image(path("x.hdr"));
  EXPECT_EQ(image.encoding, Encoding::scene_linear);
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  // Half a step is added to a mantissa by some readers; 1 % leaves room for both.
  EXPECT_NEAR(image.at(0, 0, 0), 256.0F, 2.0F);
  EXPECT_NEAR(image.at(0, 0, 1), 128.0F, 2.0F);
  EXPECT_NEAR(image.at(1, 0, 2), 1.0F, 0.01F);
}

TEST_F(ImageFiles, PortablePixmapsAreDisplayEncoded) {
  put("x.ppm", std::string("P6\n1 1\n255\n") + std::string("\x80\x00\xff", 3));
  const Image image = read_image(path("x.ppm"));
  EXPECT_EQ(image.encoding, Encoding::display);
  EXPECT_EQ(image.pixels, (std::vector<float>{128.0F / 255.0F, 0.0F, 1.0F}));
  EXPECT_EQ(read_image(path("x.ppm"), Encoding::scene_linear).encoding, Encoding::scene_linear);
}

TEST_F(ImageFiles, JpegIsDisplayEncodedAndATruncatedOneIsAnError) {
  const std::string bytes = bytes_from_hex(kGreyJpeg);
  const Image image = read_image(put("x.jpg", bytes));
  EXPECT_EQ(image.encoding, Encoding::display);
  EXPECT_EQ(image.pixels, std::vector<float>(64, 128.0F / 255.0F));
  for (const std::size_t size : {10U, 100U, 300U, 345U}) {
    const std::string file = put("cut.jpg", bytes.substr(0, size));
    tests::expect_error_with<base::InputError>([&] { read_image_file(file); },
                                               {file, "cannot be read as an image"});
  }
}

TEST_F(ImageFiles, TiffOfIntegersIsDisplayAndOfFloatsSceneLinear) {
  put("x.tif", grey_tiff(16, 1, little_endian(65535, 2) + little_endian(12345, 2)));
  const Image integers = read_image(path("x.tif"));
  EXPECT_EQ(integers.encoding, Encoding::display);
  EXPECT_EQ(integers.pixels, (std::vector<float>{1.0F, 12345.0F / 65535.0F}));
  put("y.tif", grey_tiff(32, 3, little_endian(std::bit_cast<std::uint32_t>(-2.5F), 4)));
  const Image floats = read_image(path("y.tif"));
  EXPECT_EQ(floats.encoding, Encoding::scene_linear);
  EXPECT_EQ(floats.pixels, std::vector<float>{-2.5F});
}

TEST_F(ImageFiles, AnExrUnderAnotherNameIsAnExr) {
  write_exr(path("x.exr"), {{{"", make_rgb_image(2, 2, Encoding::scene_linear)}}, {}});
  std::filesystem::rename(path("x.exr"), path("x.png"));
  EXPECT_EQ(read_image(path("x.png")).encoding, Encoding::scene_linear);
}

TEST_F(ImageFiles, NanPixelsAreRead) {
  Image image = make_rgb_image(2, 2, Encoding::scene_linear);
  image.at(1, 0, 2) = std::numeric_limits<float>::quiet_NaN();
  write_exr(path("x.exr"), {{{"", image}}, {}});
  EXPECT_EQ(count_non_finite(read_image(path("x.exr"))).pixels, 1U);
}

TEST_F(ImageFiles, MissingEmptyFolderAndTextAreTold) {
  const auto fails = [](const std::filesystem::path& file, const std::string& reason) {
    tests::expect_error<base::InputError>(
        [&] { read_image_file(file); }, file.string() + ": cannot be read as an image: " + reason);
  };
  fails(path("none.exr"), "there is no such file");
  fails(path("none.png"), "there is no such file");
  fails(put("empty.exr", ""), "the file is empty");
  fails(put("empty.jpg", ""), "the file is empty");
  fails(put("text.exr", "schema: 1\nscene: box\n"),
        "it is not an EXR file, whose first bytes are 76 2f 31 01");
  std::filesystem::create_directory(path("folder.exr"));
  fails(path("folder.exr"), "it is a folder");
}

TEST_F(ImageFiles, UnknownFormatsAreTold) {
  const std::string file = put("x.xcf", "gimp");
  tests::expect_error<base::InputError>(
      [&] { read_image_file(file); },
      file +
          ": unknown image format \"xcf\"; known: exr, png, jpg, jpeg, hdr, pfm, tif, tiff, tga, "
          "bmp, ppm, pgm");
  EXPECT_THROW(read_image_file(put("noextension", "x")), base::InputError);
}

TEST_F(ImageFiles, ATruncatedPngIsAnErrorAtEveryLength) {
  const std::string bytes = png_bytes(ramp({"R", "G", "B"}));
  for (const double part : {0.05, 0.2, 0.5, 0.8, 0.9}) {
    const auto size = static_cast<std::size_t>(static_cast<double>(bytes.size()) * part);
    const std::string file = put("cut.png", bytes.substr(0, size));
    tests::expect_error_with<base::InputError>([&] { read_image_file(file); },
                                               {file, "cannot be read as an image"});
  }
  const std::string file = put("cut.png", bytes.substr(0, bytes.size() - 1));
  tests::expect_error<base::InputError>(
      [&] { read_image_file(file); },
      file + ": cannot be read as an image: the PNG file is truncated");
}

TEST_F(ImageFiles, ADamagedPngIsAnError) {
  std::string bytes = png_bytes(ramp({"Y"}));
  const std::size_t data = bytes.find("IDAT");
  bytes[data + 10] = static_cast<char>(bytes[data + 10] ^ 0x10);
  const std::string file = put("bad.png", bytes);
  tests::expect_error_with<base::InputError>([&] { read_image_file(file); },
                                             {file, "cannot be read as an image"});
}

TEST_F(ImageFiles, TextUnderPictureNamesIsAnError) {
  for (const char* name : {"x.png", "x.jpg", "x.hdr", "x.tif", "x.bmp", "x.ppm", "x.pfm"}) {
    const std::string file = put(name, "this is not a picture, whatever its name says\n");
    tests::expect_error_with<base::InputError>([&] { read_image_file(file); },
                                               {file, "cannot be read as"});
  }
}

}  // namespace
}  // namespace perception

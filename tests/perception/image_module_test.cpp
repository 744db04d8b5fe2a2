#include "perception/image_module.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "tests/expect_error.h"
#include "tests/temporary_folder.h"

namespace perception {
namespace {

TEST(ImageModule, IsSoughtBesideTheProgramThenInLibThenWhereTheEnvironmentSays) {
  setenv("DISCERN_MODULE_DIR", "/opt/modules", 1);
  const std::vector<std::filesystem::path> folders = image_module_folders();
  unsetenv("DISCERN_MODULE_DIR");
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  ASSERT_EQ(folders.size(), 3U);
  EXPECT_EQ(folders[0], here);
  EXPECT_EQ(folders[1], here.parent_path() / "lib" / "discern");
  EXPECT_EQ(folders[2], "/opt/modules");
  EXPECT_EQ(image_module_folders().size(), 2U);
}

TEST(ImageModule, AMissingModuleIsADeviceErrorWithThePathsTried) {
  const tests::TemporaryFolder folder;
  const std::vector<std::filesystem::path> folders{folder.path() / "a", folder.path() / "b"};
  const std::string message =
      "the module of image formats (all but EXR and PFM) is missing; tried: " +
      (folders[0] / "discern_openimageio.so").string() + ", " +
      (folders[1] / "discern_openimageio.so").string() +
      "; accepted also: its folder in $DISCERN_MODULE_DIR";
  tests::expect_error<base::DeviceError>(
      [&] {
        encode_with_module(folders, {1, 1, 1, {0}});
      },
      message);
  tests::expect_error<base::DeviceError>(
      [&] { decode_with_module(folders, "x.png", std::nullopt); }, message);
}

TEST(ImageModule, ABrokenModuleIsADeviceErrorWithItsPath) {
  const tests::TemporaryFolder folder;
  base::write_text_file(folder.path() / "discern_openimageio.so", "not a library");
  const std::vector<std::filesystem::path> folders{folder.path()};
  tests::expect_error_with<base::DeviceError>(
      [&] {
        encode_with_module(folders, {1, 1, 1, {0}});
      },
      {(folder.path() / "discern_openimageio.so").string(), "cannot be opened"});
}

TEST(ImageModule, TheProgramItselfDoesNotLinkOpenImageIO) {
  // An earlier test may have opened the module, so this looks at the names in the program's file;
  // the name sought is put together here, or it would be found as this test's own text.
  const std::string program = base::read_text_file("/proc/self/exe");
  std::string name = "libOpen";
  name.append("ImageIO.so");
  EXPECT_EQ(program.find(name), std::string::npos);
  EXPECT_NE(program.find("libOpenEXR"), std::string::npos);  // the search does find names
}

}  // namespace
}  // namespace perception

#include "renderers/scene/file_locator.h"

#include "tests/expect_input_error.h"
#include "tests/renderers/scene/scene_text.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

namespace renderers::scene {
namespace {

std::filesystem::path locate(const char* text, const std::filesystem::path& folder) {
  const base::Node node = base::parse_document(text, "s.yaml");
  base::MapReader reader(node, "mesh");
  return read_file_reference(reader, folder);
}

TEST(FileLocator, RelativePathsStartAtTheFolder) {
  const tests::TemporaryFolder folder;
  tests::write(folder.path() / "a.obj", "x");
  EXPECT_EQ(locate("{file: a.obj}", folder.path()), folder.path() / "a.obj");
}

TEST(FileLocator, FindsFilesOfDebianPackages) {
  EXPECT_EQ(locate("{file: models/horse.3ds, package: glmark2-data}", ""),
            "/usr/share/glmark2/models/horse.3ds");
  EXPECT_EQ(locate("{file: horse.3ds, package: glmark2-data}", ""),
            "/usr/share/glmark2/models/horse.3ds");
}

TEST(FileLocator, MatchesWholeFileNames) {
  EXPECT_NE(tests::input_error_of([] { locate("{file: orse.3ds, package: glmark2-data}", ""); }),
            "no error");
}

TEST(FileLocator, MissingPackageSaysHowToInstallIt) {
  EXPECT_EQ(tests::input_error_of([] { locate("{file: dragon.ply, package: no-such-data}", ""); }),
            "s.yaml:1:8: dragon.ply: not found; it is in the Debian package no-such-data (sudo "
            "apt-get install no-such-data)");
}

TEST(FileLocator, PackageNamesAreNoPaths) {
  EXPECT_EQ(tests::input_error_of([] { locate("{file: a.ply, package: ../secret}", ""); }),
            "s.yaml:1:24: \"../secret\" is no name of a Debian package");
}

}  // namespace
}  // namespace renderers::scene

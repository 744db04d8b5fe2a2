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

/// An installed package "toys" with nine meshes and a picture.
class InstalledPackage : public ::testing::Test {
 protected:
  InstalledPackage() {
    std::string list = "/.\n" + folder_.path().string() + "\n";
    for (const char* name : {"i.obj", "a.obj", "b.3ds", "c.obj", "d.obj", "e.obj", "f.obj", "g.obj",
                             "h.glb", "p.png"}) {
      tests::write(folder_.path() / name, "x");
      list += (folder_.path() / name).string() + "\n";
    }
    tests::write(folder_.path() / "toys.list", list + (folder_.path() / "gone.obj").string());
  }

  std::string error_of(const char* text) {
    return tests::input_error_of([&] {
      const base::Node node = base::parse_document(text, "s.yaml");
      base::MapReader reader(node, "mesh");
      read_file_reference(reader, "", folder_.path());
    });
  }

  tests::TemporaryFolder folder_;
};

TEST_F(InstalledPackage, SaysWhatItHasInstead) {
  EXPECT_EQ(error_of("{file: a.obj, package: toys}"), "no error");
  EXPECT_EQ(error_of("{file: a2.3ds, package: toys}"),
            "s.yaml:1:8: \"a2.3ds\": not among the files of the installed Debian package toys; it "
            "has: a.obj, b.3ds, c.obj, d.obj, e.obj, f.obj, g.obj, h.glb and 1 more");
  EXPECT_EQ(error_of("{file: q.jpg, package: toys}"),
            "s.yaml:1:8: \"q.jpg\": not among the files of the installed Debian package toys; it "
            "has: p.png");
  EXPECT_EQ(error_of("{file: q.txt, package: toys}"),
            "s.yaml:1:8: \"q.txt\": not among the files of the installed Debian package toys; it "
            "has: no .txt");
}

TEST_F(InstalledPackage, DeletedFileIsReinstalled) {
  EXPECT_EQ(error_of("{file: gone.obj, package: toys}"),
            "s.yaml:1:8: gone.obj: the installed Debian package toys lists " +
                (folder_.path() / "gone.obj").string() +
                ", which is not there (sudo apt-get install --reinstall toys)");
}

TEST(FileLocator, PackageNamesAreNoPaths) {
  EXPECT_EQ(tests::input_error_of([] { locate("{file: a.ply, package: ../secret}", ""); }),
            "s.yaml:1:24: \"../secret\" is no name of a Debian package");
}

}  // namespace
}  // namespace renderers::scene

#include "renderers/scene/generators/library.h"

#include "renderers/scene/generators/mesh_pieces.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/scene/generators/mesh_facts.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <numbers>
#include <string>

namespace renderers::scene {
namespace {

std::vector<GeneratedPart> library_of(const std::string& settings) {
  return generate(base::parse_document("{name: library" + settings + "}", "l.yaml"));
}

/// A prism over a rectangle and half an ellipse, wherever it stands; all fronts are outside.
TEST(Book, IsClosedAndHasItsVolume) {
  BookShape shape;
  shape.spine_segments = 64;
  const glm::mat4 place =
      glm::rotate(glm::translate(glm::mat4(1.0F), {0.3F, 1.0F, -0.2F}), 0.7F, {0, 1, 0});
  Mesh book;
  add_book(book, book, shape, place);
  EXPECT_EQ(static_cast<int>(book.triangles.size()), book_triangles(64));
  const double half_m = 0.5 * static_cast<double>(shape.thickness_m);
  const double section_m2 = 2.0 * half_m * static_cast<double>(shape.depth_m) +
                            0.5 * std::numbers::pi * 0.3 * half_m * half_m;
  const double volume_m3 = section_m2 * static_cast<double>(shape.height_m);
  EXPECT_NEAR(tests::volume_m3(book), volume_m3, 1e-3 * volume_m3);
  EXPECT_EQ(tests::turned_normals(book), 0);
}

TEST(Cuboid, LooksOutwards) {
  Mesh box;
  add_cuboid(box, {0, 0, 0}, {1, 2, 3}, glm::translate(glm::mat4(1.0F), {5, 5, 5}));
  EXPECT_NEAR(tests::volume_m3(box), 6.0, 1e-4);
  EXPECT_EQ(tests::turned_normals(box), 0);
}

TEST(Library, HasItsTrianglesItsLampsAndItsBooks) {
  std::size_t triangles = 0;
  int lamps = 0;
  double lamp_area_m2 = 0.0;
  std::size_t cover_vertices = 0;
  std::size_t page_vertices = 0;
  for (const GeneratedPart& part : library_of(", triangles: 200000")) {
    triangles += part.mesh.triangles.size();
    ASSERT_EQ(part.mesh.normals.size(), part.mesh.positions.size()) << part.name;
    ASSERT_EQ(part.mesh.uvs.size(), part.mesh.positions.size()) << part.name;
    if (part.name.starts_with("books-")) cover_vertices += part.mesh.positions.size();
    if (part.name == "pages") page_vertices = part.mesh.positions.size();
    if (!part.material.is_emissive()) continue;
    ++lamps;
    lamp_area_m2 += tests::area_m2(part.mesh);
    EXPECT_LT(tests::area_vector(part.mesh, part.mesh.triangles[0]).y, 0.0);  // shines down
  }
  EXPECT_NEAR(static_cast<double>(triangles), 200000.0, 200.0);
  EXPECT_EQ(lamps, 80);
  EXPECT_NEAR(lamp_area_m2, 80 * 1.4 * 0.4, 1e-3);
  // A book has 4 s + 8 vertices of its cover and 2 s + 10 of its pages.
  const std::size_t books = (2 * page_vertices - cover_vertices) / 12;
  EXPECT_GT(books, 12000U);
  EXPECT_LT(books, 13500U);
}

TEST(Library, RefusesNumbersItCannotMeet) {
  EXPECT_NE(tests::input_error_of([] { library_of(", triangles: 1000"); }), "no error");
}

}  // namespace
}  // namespace renderers::scene

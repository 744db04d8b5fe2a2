#include "renderers/scene/generators/library.h"

#include "renderers/scene/generators/mesh_pieces.h"
#include "renderers/scene/generators/uniform_number.h"
#include "renderers/scene/value_reader.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>

namespace renderers::scene {
namespace {

constexpr int kDefaultTriangles = 500000;
constexpr int kLeastTriangles = 200000;
constexpr int kMostTriangles = 2000000;

// The room, metres.
constexpr float kHalfWidth_m = 5.0F;
constexpr float kLength_m = 16.0F;
constexpr float kHeight_m = 3.2F;

// A bookcase: width along x, spines towards +z, back at z = 0.
constexpr float kCase_m = 1.0F;
constexpr float kCaseDepth_m = 0.30F;
constexpr float kCaseHeight_m = 2.3F;
constexpr float kBoard_m = 0.022F;
constexpr int kShelves = 7;

constexpr std::size_t kCovers = 6;

// Panels of light, along x and z: 80 in all.
constexpr int kLampColumns = 5;
constexpr int kLampRows = 16;

struct Book {
  BookShape shape;
  glm::mat4 place{1.0F};
  std::size_t cover = 0;
};

glm::mat4 turned(float x, float z, float turn_deg) {
  const glm::mat4 moved = glm::translate(glm::mat4(1.0F), glm::vec3(x, 0.0F, z));
  return glm::rotate(moved, glm::radians(turn_deg), glm::vec3(0.0F, 1.0F, 0.0F));
}

/// Places of all bookcases: along three walls, and in double rows that reach into the room.
std::vector<glm::mat4> case_places() {
  std::vector<glm::mat4> places;
  for (int i = 0; i < 15; ++i) {
    const float z = 0.5F + kCase_m * (static_cast<float>(i) + 0.5F);
    places.push_back(turned(-kHalfWidth_m, z, 90.0F));
    places.push_back(turned(kHalfWidth_m, z, -90.0F));
  }
  for (int i = 0; i < 8; ++i) {
    places.push_back(turned(-3.5F + kCase_m * static_cast<float>(i), kLength_m, 180.0F));
  }
  for (int row = 0; row < 4; ++row) {
    const float z = 6.0F + 2.4F * static_cast<float>(row);
    for (const float side : {-1.0F, 1.0F}) {
      for (int i = 0; i < 2; ++i) {
        const float x = side * (1.75F + kCase_m * static_cast<float>(i));
        places.push_back(turned(x, z, 0.0F));
        places.push_back(turned(x, z, 180.0F));
      }
    }
  }
  return places;
}

float shelf_height_m(int shelf) {
  return 0.08F + (kCaseHeight_m - 0.1F) * static_cast<float>(shelf) / static_cast<float>(kShelves);
}

void add_case(Mesh& mesh, const glm::mat4& place) {
  const float half_m = 0.5F * kCase_m;
  for (const float side : {-1.0F, 1.0F}) {
    const float x = side * (half_m - 0.5F * kBoard_m);
    add_cuboid(mesh, {x - 0.5F * kBoard_m, 0.0F, 0.01F},
               {x + 0.5F * kBoard_m, kCaseHeight_m, kCaseDepth_m}, place);
  }
  add_cuboid(mesh, {-half_m + kBoard_m, 0.0F, 0.002F}, {half_m - kBoard_m, kCaseHeight_m, 0.01F},
             place);
  for (int shelf = 0; shelf <= kShelves; ++shelf) {
    const float top_m = shelf_height_m(shelf);
    add_cuboid(mesh, {-half_m + kBoard_m, top_m - kBoard_m, 0.01F},
               {half_m - kBoard_m, top_m, kCaseDepth_m}, place);
  }
}

/// Books of one shelf from left to right, now and then a gap, a set of one colour or a single one.
void fill_shelf(std::mt19937_64& engine, const glm::mat4& place, int shelf,
                std::vector<Book>& books) {
  const float end_m = 0.5F * kCase_m - kBoard_m - 0.004F;
  float x = -end_m;
  while (x < end_m - 0.06F) {
    if (uniform(engine, 0.0F, 1.0F) < 0.06F) x += uniform(engine, 0.05F, 0.25F);
    const auto set = static_cast<int>(uniform(engine, 1.0F, 7.0F));
    Book book;
    book.cover = static_cast<std::size_t>(uniform(engine, 0.0F, static_cast<float>(kCovers)));
    book.shape.height_m = uniform(engine, 0.18F, 0.28F);
    book.shape.depth_m = uniform(engine, 0.14F, 0.20F);
    const float thickness_m = uniform(engine, 0.015F, 0.05F);
    for (int i = 0; i < set; ++i) {
      book.shape.thickness_m = thickness_m * uniform(engine, 0.8F, 1.2F);
      const float middle_m = x + 0.5F * book.shape.thickness_m;
      if (middle_m + 0.5F * book.shape.thickness_m > end_m) return;
      book.place = glm::translate(
          place, glm::vec3(middle_m, shelf_height_m(shelf) + 0.001F,
                           kCaseDepth_m - book.shape.depth_m - uniform(engine, 0.02F, 0.06F)));
      books.push_back(book);
      x += book.shape.thickness_m + 0.001F;
    }
  }
}

void add_table(Mesh& mesh, float x, float z) {
  const glm::mat4 place = turned(x, z, 0.0F);
  add_cuboid(mesh, {-0.6F, 0.72F, -0.9F}, {0.6F, 0.76F, 0.9F}, place);
  for (const float side : {-1.0F, 1.0F}) {
    for (const float end : {-1.0F, 1.0F}) {
      const glm::vec3 middle(side * 0.52F, 0.0F, end * 0.82F);
      add_cuboid(mesh, middle - glm::vec3(0.03F, 0.0F, 0.03F),
                 middle + glm::vec3(0.03F, 0.72F, 0.03F), place);
    }
    // A bench on either side.
    const float seat = side * 0.95F;
    add_cuboid(mesh, {seat - 0.17F, 0.42F, -0.8F}, {seat + 0.17F, 0.46F, 0.8F}, place);
    for (const float end : {-0.7F, 0.7F}) {
      add_cuboid(mesh, {seat - 0.15F, 0.0F, end - 0.02F}, {seat + 0.15F, 0.42F, end + 0.02F},
                 place);
    }
  }
}

/// Parts other than books and pages.
struct Room {
  Mesh cases;
  Mesh ceiling;
  Mesh floor;
  Mesh tables;
  Mesh walls;
  std::vector<Mesh> lamps;  ///< a panel each
};

Room empty_room() {
  Room room;
  const float w = 2.0F * kHalfWidth_m;
  add_parallelogram(room.floor, {-kHalfWidth_m, 0, 0}, {0, 0, kLength_m}, {w, 0, 0});
  add_parallelogram(room.ceiling, {-kHalfWidth_m, kHeight_m, 0}, {w, 0, 0}, {0, 0, kLength_m});
  add_parallelogram(room.walls, {-kHalfWidth_m, 0, 0}, {w, 0, 0}, {0, kHeight_m, 0});
  add_parallelogram(room.walls, {-kHalfWidth_m, 0, kLength_m}, {0, kHeight_m, 0}, {w, 0, 0});
  add_parallelogram(room.walls, {-kHalfWidth_m, 0, 0}, {0, kHeight_m, 0}, {0, 0, kLength_m});
  add_parallelogram(room.walls, {kHalfWidth_m, 0, 0}, {0, 0, kLength_m}, {0, kHeight_m, 0});
  for (int i = 0; i < kLampColumns; ++i) {
    for (int j = 0; j < kLampRows; ++j) {
      const glm::vec3 corner(-4.5F + 1.9F * static_cast<float>(i), kHeight_m - 0.02F,
                             0.3F + static_cast<float>(j));
      add_parallelogram(room.lamps.emplace_back(), corner, {1.4F, 0, 0}, {0, 0, 0.4F});
    }
  }
  for (const glm::mat4& place : case_places()) add_case(room.cases, place);
  for (const float x : {-2.3F, 2.3F}) {
    for (const float z : {1.9F, 4.1F}) add_table(room.tables, x, z);
  }
  return room;
}

GeneratedPart part_of(std::string name, Mesh mesh, const glm::vec3& albedo) {
  GeneratedPart part;
  part.name = std::move(name);
  part.mesh = std::move(mesh);
  part.material.albedo = albedo;
  return part;
}

/// Cloth and leather; ours.
constexpr std::array<glm::vec3, kCovers> kCoverColors{{{0.42F, 0.09F, 0.07F},
                                                       {0.10F, 0.20F, 0.38F},
                                                       {0.13F, 0.30F, 0.15F},
                                                       {0.48F, 0.33F, 0.16F},
                                                       {0.30F, 0.17F, 0.10F},
                                                       {0.60F, 0.55F, 0.44F}}};

/// Of every lamp, W/(m2 sr); ours.
constexpr glm::vec3 kLampRadiance{3.2F, 3.0F, 2.7F};

}  // namespace

std::vector<GeneratedPart> library(base::MapReader& reader) {
  std::mt19937_64 engine(static_cast<std::uint64_t>(reader.integer("seed", 1)));
  const base::Node* node = reader.find("triangles");
  const int triangles = node == nullptr
                            ? kDefaultTriangles
                            : read_count(*node, "triangles", kLeastTriangles, kMostTriangles);
  Room room = empty_room();
  std::vector<Book> books;
  for (const glm::mat4& place : case_places()) {
    for (int shelf = 0; shelf < kShelves; ++shelf) fill_shelf(engine, place, shelf, books);
  }
  int left = triangles;
  for (const Mesh* mesh : {&room.cases, &room.ceiling, &room.floor, &room.tables, &room.walls}) {
    left -= static_cast<int>(mesh->triangles.size());
  }
  for (const Mesh& lamp : room.lamps) left -= static_cast<int>(lamp.triangles.size());
  // Spines are as round as there are triangles left for each book, by turns one segment rounder.
  std::array<Mesh, kCovers> covers;
  Mesh pages;
  for (std::size_t i = 0; i < books.size(); ++i) {
    const auto each = left / static_cast<int>(books.size() - i);
    books[i].shape.spine_segments = std::max(1, (each - book_triangles(0)) / 4);
    left -= book_triangles(books[i].shape.spine_segments);
    add_book(covers[books[i].cover], pages, books[i].shape, books[i].place);
  }
  std::vector<GeneratedPart> parts;
  for (std::size_t i = 0; i < kCovers; ++i) {
    parts.push_back(part_of(std::string("books-") + static_cast<char>('a' + static_cast<int>(i)),
                            std::move(covers[i]), kCoverColors[i]));
  }
  parts.push_back(part_of("cases", std::move(room.cases), {0.34F, 0.21F, 0.12F}));
  parts.push_back(part_of("ceiling", std::move(room.ceiling), {0.74F, 0.73F, 0.70F}));
  parts.push_back(part_of("floor", std::move(room.floor), {0.42F, 0.32F, 0.22F}));
  for (std::size_t i = 0; i < room.lamps.size(); ++i) {
    parts.push_back(
        part_of("lamp-" + std::to_string(i + 1), std::move(room.lamps[i]), glm::vec3(0.5F)));
    parts.back().material.emission = kLampRadiance;
  }
  parts.push_back(part_of("pages", std::move(pages), {0.68F, 0.64F, 0.54F}));
  parts.push_back(part_of("tables", std::move(room.tables), {0.46F, 0.30F, 0.17F}));
  parts.push_back(part_of("walls", std::move(room.walls), {0.64F, 0.60F, 0.52F}));
  return parts;
}

}  // namespace renderers::scene

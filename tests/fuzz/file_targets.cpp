#include "tests/fuzz/fuzz_targets.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/image_file.h"
#include "renderers/scene/mesh_file.h"
#include "renderers/scene/scene_file.h"
#include "results/claims/claim.h"
#include "results/claims/expectation.h"
#include "results/claims/expression.h"
#include "results/result_store.h"
#include "results/row_selector.h"
#include "results/run_summary.h"
#include "tests/fuzz/seed_files.h"
#include "tests/places.h"
#include "tests/temporary_folder.h"

namespace tests {

namespace {

namespace fs = std::filesystem;

/// A file in a folder of the process.
fs::path written(const std::string& name, const std::string& bytes) {
  static const TemporaryFolder folder;
  const fs::path path = folder.path() / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

fs::path scene_folder() { return fs::path(kSourceFolder) / "suites/scenes"; }

Seeds small_scenes() {
  return files_of(scene_folder(), {"cornell-box-spot.yaml", "penumbra-plane.yaml",
                                   "textured-floor.yaml", "moving-box.yaml"});
}

void read_scene(const std::string& bytes) {
  renderers::scene::parse_scene(base::parse_document(bytes, "scene.yaml"), scene_folder());
}

Seeds claim_lists() {
  return {
      R"yaml(- {id: rate, item: "Sec. 2.4", says: "it falls", expect: "= -0.5 within 0.05",
   measure: "loglog_slope(pt, relmse, samples)"})yaml",
      R"yaml(- {id: a, item: Fig 1, says: b, expect: decreasing, profile: [half, paper],
   measure: ["median(val[vals=2..30], flip@full)", "min(ir, flip.p99)"], comparable: share only})yaml",
      R"yaml(- {id: c, item: Table 1, says: d, expect: "in 0.4..0.6", comparable: "no: hardware time",
   measure: "share(val, shadow + filter/basis) * 2 / (1 - value(pt[budget=64spp], total_s))",
   below_noise: skip, printed: "69 %", criterion: ours})yaml",
      R"yaml(- {id: e, item: f, says: g, expect: "<= 40%",
   measure: "least_at(a, rays, relmse, 1.1 * value(b, relmse))"})yaml"};
}

void read_claims(const std::string& bytes) {
  results::claims::read_claims(base::parse_document(bytes, "suite.yaml"));
}

Seeds expressions() {
  return {"loglog_slope(pt, relmse, samples)", "series(val[vals=2..30,scene=box|room], flip, vals)",
          "abs(value(a, mse)) / (1 - share_of(restart, vals >= 30))", "quantile(a, total_s, 0.95)"};
}

void read_expression(const std::string& bytes) {
  results::claims::parse_expression(bytes, {"suite.yaml", 1, 1});
}

Seeds expectations() {
  return {"= 34.1 within 5%", "in 0.4..0.6",        ">= 0.95",
          "increasing",       "= -0.5 within 0.05", "largest"};
}

void read_expectation(const std::string& bytes) {
  results::claims::parse_expectation(bytes, {"suite.yaml", 1, 1});
}

Seeds selectors() {
  return {"val[vals=2..30]", "*[scene=horse, budget=64spp]", "a[clamp>=0.1,budget='relmse=0.05']"};
}

void read_selector(const std::string& bytes) {
  results::parse_row_selector(bytes, {"suite.yaml", 1, 1});
}

Seeds records() {
  results::CellRecord cell;
  cell.cell = "box.pt.64spp.s1-0a1b2c3d";
  cell.scene = "box";
  cell.method = "pt";
  cell.budget = "64spp";
  cell.render.total_s = 1.25;
  cell.render.stages.resize(1);
  return {to_json(cell).dump() + "\n"};
}

/// A run folder that was copied from somewhere.
void read_records(const std::string& bytes) {
  const fs::path file = written("cells.jsonl", bytes);
  const results::Run run = results::load_run(file.parent_path());
  results::summarize(run);
  if (run.unreadable_lines > 0) throw base::InputError("cut lines");
}

Seeds text_meshes() {
  return {"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n",
          "# two faces\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf -4 -3 -2\n"};
}

void read_mesh(const std::string& name, const std::string& bytes) {
  std::vector<std::string> warnings;
  renderers::scene::read_mesh_file(written(name, bytes), {}, warnings);
}
void read_obj(const std::string& bytes) { read_mesh("mesh.obj", bytes); }

Seeds ply_meshes() {
  return {
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
      "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
      "0\n0 1 0\n3 0 1 2\n"};
}
void read_ply(const std::string& bytes) { read_mesh("mesh.ply", bytes); }

Seeds gltf_meshes() {
  return {R"json({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0,"scale":[1,2,1]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})json"};
}
void read_gltf(const std::string& bytes) { read_mesh("mesh.gltf", bytes); }

/// A number in the byte order of the formats here, little-endian.
template <typename Number>
std::string bytes_of(Number number) {
  std::string bytes(sizeof(number), '\0');
  std::memcpy(bytes.data(), &number, sizeof(number));
  return bytes;
}

std::string bytes_of(std::initializer_list<float> numbers) {
  std::string bytes;
  for (const float number : numbers) bytes += bytes_of(number);
  return bytes;
}

constexpr std::initializer_list<float> kCorners{0, 0, 0, 1, 0, 0, 0, 1, 0};

Seeds glb_meshes() {
  std::string json = R"json({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]})json";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto chunk = [](std::string_view kind, const std::string& data) {
    return bytes_of(static_cast<std::uint32_t>(data.size())) + std::string(kind) + data;
  };
  const std::string chunks =
      chunk("JSON", json) + chunk(std::string_view("BIN\0", 4), bytes_of(kCorners));
  return {"glTF" + bytes_of(std::uint32_t{2}) +
          bytes_of(static_cast<std::uint32_t>(12 + chunks.size())) + chunks};
}
void read_glb(const std::string& bytes) { read_mesh("mesh.glb", bytes); }

Seeds three_ds_meshes() {
  const auto chunk = [](std::uint16_t id, const std::string& data) {
    return bytes_of(id) + bytes_of(static_cast<std::uint32_t>(6 + data.size())) + data;
  };
  const std::string corners = chunk(0x4110, bytes_of(std::uint16_t{3}) + bytes_of(kCorners));
  std::string faces = bytes_of(std::uint16_t{1});
  for (const std::uint16_t corner : std::initializer_list<std::uint16_t>{0, 1, 2, 7})
    faces += bytes_of(corner);  // flags last
  const std::string mesh = chunk(0x4100, corners + chunk(0x4120, faces));
  const std::string object = chunk(0x4000, std::string("object\0", 7) + mesh);
  return {chunk(0x4d4d, chunk(0x0002, bytes_of(std::uint32_t{3})) + chunk(0x3d3d, object))};
}
void read_three_ds(const std::string& bytes) { read_mesh("mesh.3ds", bytes); }

/// The bytes of a small picture.
Seeds picture(const std::string& name) {
  perception::Image image =
      perception::make_gray_image(7, 5, "Y", perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = 0.03F * static_cast<float>(i % 30);
  }
  const fs::path path = written(name, "");
  if (path.extension() == ".exr") {
    perception::ImageFile file;
    file.parts.push_back({"", image});
    perception::write_exr(path, file);
  } else {
    image.encoding = perception::Encoding::display;
    perception::write_png(path, image);
  }
  return {base::read_text_file(path)};
}
Seeds exr_pictures() { return picture("seed.exr"); }
void read_exr(const std::string& bytes) { perception::read_image(written("picture.exr", bytes)); }

Seeds pfm_pictures() { return {std::string("Pf\n2 2\n-1.0\n") + std::string(16, '\x3f')}; }
void read_pfm(const std::string& bytes) { perception::read_image(written("picture.pfm", bytes)); }

constexpr std::array kTargets{
    FuzzTarget{"scene", small_scenes, read_scene},
    FuzzTarget{"claims", claim_lists, read_claims},
    FuzzTarget{"expression", expressions, read_expression},
    FuzzTarget{"expectation", expectations, read_expectation},
    FuzzTarget{"selector", selectors, read_selector},
    FuzzTarget{"records", records, read_records},
    FuzzTarget{"obj", text_meshes, read_obj},
    FuzzTarget{"ply", ply_meshes, read_ply},
    FuzzTarget{"gltf", gltf_meshes, read_gltf},
    FuzzTarget{"glb", glb_meshes, read_glb},
    FuzzTarget{"3ds", three_ds_meshes, read_three_ds},
    FuzzTarget{"exr", exr_pictures, read_exr},
    FuzzTarget{"pfm", pfm_pictures, read_pfm},
};

}  // namespace

std::span<const FuzzTarget> file_targets() { return kTargets; }

}  // namespace tests

#include "tests/suites/command_line/bad_input_rows.h"

namespace tests {

const char* const kGoodScene =
    "schema: 1\n"
    "scene: small\n"
    "camera: {position: [0, 1, 5], look_at: [0, 1, 0], vertical_fov_deg: 40}\n"
    "materials: {white: {albedo: [0.5, 0.5, 0.5]}}\n"
    "objects: [{name: floor, quad: {origin: [-1, 0, -1], edge_u: [0, 0, 2], edge_v: [2, 0, 0]}, "
    "material: white}]\n"
    "lights: [{name: key, type: point, position: [0, 2, 0], intensity: [9, 9, 9]}]\n";

std::vector<std::string> render(const std::string& scene) {
  return {"render", "--scene",   scene, "--renderer", "path",  "--size",
          "4x4",    "--samples", "1",   "--out",      "@o.exr"};
}

namespace {

const std::vector<BadInputRow> kScenes{
    {"no YAML",
     {"scene.yaml", "schema: 1", "schema: {"},
     render(),
     "@scene.yaml:3:7: not valid YAML or JSON: end of map flow not found"},
    {"empty",
     {"scene.yaml", "*", ""},
     render(),
     "@scene.yaml:1:1: scene file must be a map of keys and values, not nothing"},
    {"no camera",
     {"scene.yaml", "camera: {position: [0, 1, 5], look_at: [0, 1, 0], vertical_fov_deg: 40}\n",
      ""},
     render(),
     "@scene.yaml:1:1: scene has no camera; add camera: {position, look_at, vertical_fov_deg}"},
    {"no objects",
     {"scene.yaml",
      "objects: [{name: floor, quad: {origin: [-1, 0, -1], edge_u: [0, 0, 2], edge_v: [2, 0, 0]}, "
      "material: white}]\n",
      ""},
     render(),
     "@scene.yaml:1:1: scene has no objects"},
    {"unknown key",
     {"scene.yaml", "lights:", "lihgts:"},
     render(),
     "@scene.yaml:6:1: unknown key \"lihgts\"; did you mean \"lights\"? known: ..."},
    {"unknown material",
     {"scene.yaml", "material: white", "material: wite"},
     render(),
     "@scene.yaml:5:102: unknown material \"wite\"; did you mean \"white\"? known: white"},
    {"unknown kind of light",
     {"scene.yaml", "type: point", "type: pont"},
     render(),
     "@scene.yaml:6:28: unknown type of light \"pont\"; did you mean \"point\"? known: point, "
     "spot"},
    {"albedo above 1",
     {"scene.yaml", "[0.5, 0.5, 0.5]", "[1.5, 0.5, 0.5]"},
     render(),
     "@scene.yaml:4:29: albedo 1.5 is outside [0, 1]"},
    {"albedo of two numbers",
     {"scene.yaml", "[0.5, 0.5, 0.5]", "[0.5, 0.5]"},
     render(),
     "@scene.yaml:4:29: albedo must hold 3 numbers, not 2"},
    {"not a number",
     {"scene.yaml", "[0.5, 0.5, 0.5]", "[.nan, 0.5, 0.5]"},
     render(),
     "@scene.yaml:4:30: \".nan\" is not accepted: write true or false, a finite number, or quote "
     "it if text is meant"},
    {"camera looks nowhere",
     {"scene.yaml", "look_at: [0, 1, 0]", "look_at: [0, 1, 5]"},
     render(),
     "@scene.yaml:3:40: look_at is the camera's position"},
    {"field of view of 180",
     {"scene.yaml", "vertical_fov_deg: 40", "vertical_fov_deg: 180"},
     render(),
     "@scene.yaml:3:69: vertical_fov_deg 180 is outside (0, 180)"},
    {"luminance scale of 0",
     {"scene.yaml", "scene: small", "scene: small\nluminance_scale_cd_m2: 0"},
     render(),
     "@scene.yaml:3:24: luminance_scale_cd_m2 0 must be greater than 0"},
    {"include that is not there",
     {"scene.yaml", "scene: small", "scene: small\ninclude: none.yaml"},
     render(),
     "@scene.yaml:3:10: included file none.yaml not found (looked for @none.yaml)"},
    {"include of itself",
     {"scene.yaml", "scene: small", "scene: small\ninclude: scene.yaml"},
     render(),
     "@scene.yaml:3:10: scene.yaml includes itself"},
    {"object of no kind",
     {"scene.yaml", "quad: {origin: [-1, 0, -1], edge_u: [0, 0, 2], edge_v: [2, 0, 0]}, ", ""},
     render(),
     "@scene.yaml:5:11: object \"floor\" has no shape; it needs exactly one of: mesh, quad, "
     "polygons, box, sphere, disk, generator"},
    {"object of two kinds",
     {"scene.yaml", "material: white", "material: white, mesh: {file: a.obj}"},
     render(),
     "@scene.yaml:5:11: object \"floor\" has the shapes mesh, quad; it needs exactly one of: mesh, "
     "quad, polygons, box, sphere, disk, generator"},
    {"mesh that is not there",
     {"scene.yaml", "quad: {origin: [-1, 0, -1], edge_u: [0, 0, 2], edge_v: [2, 0, 0]}",
      "mesh: {file: none.obj}"},
     render(),
     "@scene.yaml:5:38: none.obj: not found (looked for @none.obj)"},
    {"package that is not installed",
     {"scene.yaml", "quad: {origin: [-1, 0, -1], edge_u: [0, 0, 2], edge_v: [2, 0, 0]}",
      "mesh: {file: a.obj, package: no-such-data}"},
     render(),
     "@scene.yaml:5:38: a.obj: not found; it is in the Debian package no-such-data (sudo apt-get "
     "install no-such-data)"},
    {"unknown generator",
     {"scene.yaml", "quad: {origin: [-1, 0, -1], edge_u: [0, 0, 2], edge_v: [2, 0, 0]}",
      "generator: {name: atriun}"},
     render(),
     "@scene.yaml:5:43: unknown generator \"atriun\"; did you mean \"atrium\"? known: ..."},
    {"unknown parameter of a generator",
     {"scene.yaml", "quad: {origin: [-1, 0, -1], edge_u: [0, 0, 2], edge_v: [2, 0, 0]}",
      "generator: {name: atrium, sed: 1}"},
     render(),
     "@scene.yaml:5:51: unknown key \"sed\"; did you mean \"seed\"? known: name, seed, triangles "
     "in generator"},
    {"texture that is not there",
     {"scene.yaml", "albedo: [0.5, 0.5, 0.5]", "albedo_texture: {file: none.png}"},
     render(),
     "@scene.yaml:4:44: none.png: not found (looked for @none.png)"},
    {"scale of 0",
     {"scene.yaml", "material: white", "material: white, transform: {scale: 0}"},
     render(),
     "@scene.yaml:5:128: scale 0 must be greater than 0"},
};

const std::vector<BadInputRow> kMeshes{
    {"empty",
     {"a.obj", "", ""},
     render("@mesh-obj.yaml"),
     "@mesh-obj.yaml:5:31: @a.obj: the file is empty"},
    {"not a number",
     {"a.obj", "", "v 0 0 zero\n"},
     render("@mesh-obj.yaml"),
     "@mesh-obj.yaml:5:31: @a.obj:1: \"zero\" is not a finite number"},
    {"infinite vertex",
     {"a.obj", "", "v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
     render("@mesh-obj.yaml"),
     "@mesh-obj.yaml:5:31: @a.obj:1: \"inf\" is not a finite number"},
    {"face without its vertex",
     {"a.obj", "", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"},
     render("@mesh-obj.yaml"),
     "@mesh-obj.yaml:5:31: @a.obj:4: a face names vertex 4; the file has 3"},
    {"no faces",
     {"a.obj", "", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
     render("@mesh-obj.yaml"),
     "@mesh-obj.yaml:5:31: @a.obj: has no faces"},
    {"faces without area",
     {"a.obj", "", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"},
     render("@mesh-obj.yaml"),
     "@mesh-obj.yaml:5:31: @a.obj: all 1 triangles have zero area"},
    {"no header",
     {"a.ply", "", "v 0 0 0\n"},
     render("@mesh-ply.yaml"),
     "@mesh-ply.yaml:5:31: @a.ply: not a PLY file: it must begin with ply"},
    {"header without end",
     {"a.ply", "", "ply\nformat ascii 1.0\nelement vertex 3\n"},
     render("@mesh-ply.yaml"),
     "@mesh-ply.yaml:5:31: @a.ply: truncated: the PLY header has no end_header"},
    {"fewer vertices than said",
     {"a.ply", "",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n"},
     render("@mesh-ply.yaml"),
     "@mesh-ply.yaml:5:31: @a.ply: truncated: the data end at vertex 1 of 3"},
    {"cut short",
     {"a.3ds", "", "MM\x10"},
     render("@mesh-3ds.yaml"),
     "@mesh-3ds.yaml:5:31: @a.3ds: not a 3DS file: it must begin with 4d4d"},
    {"no JSON",
     {"a.gltf", "", "{"},
     render("@mesh-gltf.yaml"),
     "@mesh-gltf.yaml:5:31: @a.gltf: not glTF 2.0: ..."},
    {"glTF 1.0",
     {"a.gltf", "", "{\"asset\":{\"version\":\"1.0\"}}"},
     render("@mesh-gltf.yaml"),
     "@mesh-gltf.yaml:5:31: @a.gltf: glTF version \"1.0\"; accepted: 2.x"},
    {"no meshes",
     {"a.gltf", "", "{\"asset\":{\"version\":\"2.0\"}}"},
     render("@mesh-gltf.yaml"),
     "@mesh-gltf.yaml:5:31: @a.gltf: cannot be read as a mesh: GLTF: No scene"},
    {"required extension",
     {"a.gltf", "",
      "{\"asset\":{\"version\":\"2.0\"},\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]}"},
     render("@mesh-gltf.yaml"),
     "@mesh-gltf.yaml:5:31: @a.gltf: requires the glTF extension KHR_draco_mesh_compression; "
     "supported: none, only what glTF 2.0 itself says of triangles is read; accepted: the file "
     "exported without"},
    {"no GLB",
     {"a.glb", "", "nothing of the kind"},
     render("@mesh-glb.yaml"),
     "@mesh-glb.yaml:5:31: @a.glb: not a GLB file: it must begin with glTF"},
    {"unknown format",
     {"a.stl", "", "solid\n"},
     render("@mesh-stl.yaml"),
     "@mesh-stl.yaml:5:31: @a.stl: unknown mesh format \".stl\"; known: .obj, .ply, .3ds, .gltf, "
     ".glb"},
};

}  // namespace

const std::vector<BadInputRow>& bad_scenes() { return kScenes; }
const std::vector<BadInputRow>& bad_meshes() { return kMeshes; }

}  // namespace tests

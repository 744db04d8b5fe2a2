#include "renderers/scene/mesh_file_check.h"

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "perception/base/names.h"
#include "renderers/scene/gltf_check.h"
#include "renderers/scene/obj_check.h"
#include "renderers/scene/ply_check.h"
#include "renderers/scene/three_ds_check.h"

#include <fmt/format.h>

#include <string>

namespace renderers::scene {

std::optional<MeshFileCounts> check_mesh_file(const std::filesystem::path& path,
                                              std::vector<std::string>& warnings) {
  const std::string kind = base::kebab_case(path.extension().string());
  const std::string file = path.string();
  const std::string data = base::read_text_file(path);
  if (data.empty()) throw base::InputError(fmt::format("{}: the file is empty", file));
  if (kind == ".obj") return check_obj(data, file);
  if (kind == ".ply") return check_ply(data, file);
  if (kind == ".3ds") check_3ds(data, file);
  if (kind == ".gltf") check_gltf(data, path, warnings);
  if (kind == ".glb") check_glb(data, path, warnings);
  return std::nullopt;
}

}  // namespace renderers::scene

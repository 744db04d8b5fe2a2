#pragma once

#include "perception/base/hash.h"
#include "renderers/scene/scene.h"

#include <vector>

namespace renderers::scene {

/// Hash of everything that makes an image: geometry, the materials and textures in use, lights,
/// camera, environment and luminance scale. Names and the frame's number do not count.
/// @param mesh_hashes  of the scene's objects, in order
base::Hash content_hash(const Scene& scene, const std::vector<base::Hash>& mesh_hashes);

/// The same without the camera.
base::Hash world_hash(const Scene& scene, const std::vector<base::Hash>& mesh_hashes);

}  // namespace renderers::scene

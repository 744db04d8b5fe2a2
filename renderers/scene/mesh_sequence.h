#pragma once

#include "renderers/scene/scene.h"

namespace renderers::scene {

/// Triangles that are a function of the frame: other positions, or another topology, every frame.
class MeshSequence {
 public:
  virtual ~MeshSequence() = default;
  /// Depends on the frame alone. Frames beyond the last one give its mesh.
  virtual Mesh at_frame(int frame) const = 0;
  virtual int last_frame() const = 0;  ///< 0: the mesh never changes
};

}  // namespace renderers::scene

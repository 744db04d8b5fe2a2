#pragma once

#include "perception/base/document.h"
#include "renderers/scene/keyframes.h"
#include "renderers/scene/mesh_sequence.h"
#include "renderers/scene/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <functional>
#include <memory>
#include <vector>

/// Bending, twisting and waving of meshes, in object space, before the transform.
///
/// Barr 1984, "Global and Local Deformations of Solid Primitives", doi:10.1145/800031.808573:
/// twist and bend, and the rule for normals; read in other sources, not checked against the paper.
namespace renderers::scene {

/// A point after a deformation and the derivative of its position by the one before.
struct DeformedPoint {
  glm::dvec3 position{0.0};
  glm::dmat3 jacobian{1.0};
};

enum class DeformationType { bend, twist, wave };

/// One entry of a `deform:` list.
struct Deformation {
  DeformationType type = DeformationType::twist;
  /// twist: the axis; bend: the straight line that is bent; wave: the direction it runs along.
  int axis = 1;
  /// bend: the direction it bends towards; wave: the direction it moves points along.
  int towards = 2;
  glm::dvec3 center{0.0};  ///< metres; twist, bend
  /// twist: {rate, rad/m}; bend: {curvature, rad/m, from, to, metres along `axis` from the centre};
  /// wave: {amplitude, m, wavelength, m, phase, rad}.
  Track<std::array<double, 3>> numbers;
  /// wave: the amplitude grows along this axis from 0 at the first to full at the second place
  /// (metres); -1: it is full everywhere.
  int ramp_axis = -1;
  double ramp_from_m = 0.0;
  double ramp_to_m = 1.0;
  base::Place place;
};

/// @param numbers  of the deformation at a frame
DeformedPoint deform_point(const Deformation& deformation, const std::array<double, 3>& numbers,
                           const glm::dvec3& point);

/// All deformations of a list in order at a frame. Normals are multiplied by the inverse transpose
/// of the Jacobian (Barr 1984, Sec. 3); meshes without normals stay flat.
/// @throws base::InputError if a bend is so narrow that it turns a vertex inside out
Mesh deform(const Mesh& mesh, const std::vector<Deformation>& deformations, int frame);

/// Last frame at which one of them changes.
int last_frame_of(const std::vector<Deformation>& deformations);

/// Reads [{type: twist, axis, center, rate_deg_per_m}, {type: bend, axis, towards, center,
/// curvature_deg_per_m, from, to}, {type: wave, along, towards, amplitude, wavelength, phase_deg,
/// ramp: {axis, from, to}}]; each may have animation: {keys: [{frame, ...its numbers}]}.
std::vector<Deformation> read_deformations(const base::Node& node);

/// A mesh at rest, deformed at every frame.
class DeformedMesh : public MeshSequence {
 public:
  DeformedMesh(std::shared_ptr<const Mesh> mesh, std::vector<Deformation> deformations);
  Mesh at_frame(int frame) const override;
  int last_frame() const override { return last_frame_of(deformations_); }
  bool is_animated() const;

 private:
  std::shared_ptr<const Mesh> mesh_;
  std::vector<Deformation> deformations_;
};

}  // namespace renderers::scene

#pragma once

#include "perception/image.h"
#include "renderers/clustered_visibility/cluster_statistics.h"
#include "renderers/many_lights/surface_image.h"
#include "renderers/opengl/view.h"
#include "renderers/scene/scene.h"

/// Pictures of lights and clusters, for the eye.
namespace renderers::clustered_visibility {

/// A colour per cluster: hues by the golden angle, so that neighbours in number differ.
glm::vec3 cluster_color(int cluster);

/// Surfaces in the colour of the cluster that a light there would belong to, by the rule of
/// LightClusters; darker by the surface's albedo. Black off surfaces.
perception::Image cluster_image(const ClusterState& state, const ClusterSettings& settings,
                                const many_lights::SurfaceImage& surfaces, float diagonal_m);

/// A dot in its cluster's colour for every light that the view sees, over dim surfaces.
perception::Image light_image(const ClusterState& state, const opengl::View& view,
                              const many_lights::SurfaceImage& surfaces, float diagonal_m);

/// How many lights with flux each pixel reads, 0 off surfaces.
perception::Image light_count_image(const ClusterState& state, int interleave,
                                    const many_lights::SurfaceImage& surfaces);

}  // namespace renderers::clustered_visibility

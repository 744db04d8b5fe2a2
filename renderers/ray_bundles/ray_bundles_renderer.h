#pragma once

#include "renderers/contract/renderer.h"

/// Any number of diffuse interreflections by bundles of parallel lines through the whole scene.
///
/// Source: Hermes, Henrich, Grosch, Mueller 2010, "Global Illumination using Parallel Global
/// Ray-Bundles", VMV, pp. 65-72, doi:10.2312/PE/VMV/VMV10/065-072.
namespace renderers::ray_bundles {

RendererInfo renderer_info();

}  // namespace renderers::ray_bundles

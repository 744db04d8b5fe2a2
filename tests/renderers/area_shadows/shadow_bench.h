#pragma once

#include <string>
#include <vector>

#include "tests/renderers/scene_builder.h"

namespace renderers::test {

/// A lamp over a floor with a sheet between them that the camera, below it, does not see. Lengths
/// in metres; the picture shows the floor from -1 to 1, shadows are twice as large as the sheet.
struct ShadowBench {
  double half_lamp_m = 0.02;  ///< penumbrae are twice as wide as that
  double angle_rad = 0.0;     ///< of the sheet's edge
  double offset_m = 0.0;      ///< of the shadow's middle, across the edge
  double width_m = 0.5;       ///< of the shadow, across the edge; as long as the picture
  bool has_sheet = true;

  scene::Scene scene() const;
};

/// The picture of a renderer, square.
Frame picture_of(const scene::Scene& scene, const std::string& renderer,
                 std::vector<std::string> settings = {}, int side_px = 64);

/// Fragments above level 2 whose pixels' visibility differs by more than a tenth, by the blocks of
/// the coarsest size that it does so in: the share of shadow borders that were missed.
/// @param open  the picture without the sheet, for the visibility
double missed_share(const Frame& frame, const Frame& reference, const Frame& open,
                    int coarsest_level);

}  // namespace renderers::test

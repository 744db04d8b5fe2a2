#include "tests/renderers/area_shadows/shadow_bench.h"

#include <algorithm>
#include <cmath>

namespace renderers::test {

scene::Scene ShadowBench::scene() const {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(1.0F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  const auto l = static_cast<float>(half_lamp_m);
  builder.add_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, white);
  builder.add_quad({-l, 2.5F, -l}, {2 * l, 0, 0}, {0, 0, 2 * l}, lamp);
  const glm::vec3 along(static_cast<float>(-std::sin(angle_rad)), 0,
                        static_cast<float>(std::cos(angle_rad)));
  const glm::vec3 across(along.z, 0, -along.x);
  // Half the shadow's size at half the lamp's height.
  const auto low = static_cast<float>(0.5 * (offset_m - 0.5 * width_m));
  const glm::vec3 corner = glm::vec3(0, 1.25F, 0) + low * across - 3.0F * along;
  if (has_sheet)
    builder.add_quad(corner, 6.0F * along, static_cast<float>(0.5 * width_m) * across, white);
  builder.look({0, 1, 0}, {0, 0, 0}, 90.0F);
  return builder.scene;
}

Frame picture_of(const scene::Scene& scene, const std::string& renderer,
                 std::vector<std::string> settings, int side_px) {
  return render(scene, {.renderer = renderer,
                        .settings = std::move(settings),
                        .width_px = side_px,
                        .height_px = side_px,
                        .samples = 0});
}

namespace {

/// Whether a square's pixels differ by more than the limit.
bool has_contrast(const perception::Image& image, int x0, int y0, int side_px, float limit) {
  float least = 1e9F;
  float greatest = -1e9F;
  for (int y = y0; y < std::min(image.height_px, y0 + side_px); ++y) {
    for (int x = x0; x < std::min(image.width_px, x0 + side_px); ++x) {
      least = std::min(least, image.at(x, y));
      greatest = std::max(greatest, image.at(x, y));
    }
  }
  return greatest - least > limit;
}

}  // namespace

double missed_share(const Frame& frame, const Frame& reference, const Frame& open,
                    int coarsest_level) {
  const perception::Image& level = aov(frame, "level");
  perception::Image truth = aov(reference, "irradiance");
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    truth.pixels[i] /= aov(open, "irradiance").pixels[i];
  }
  constexpr float kContrast = 0.1F;
  const int block_px = 1 << coarsest_level;
  double crossed = 0.0;
  double missed = 0.0;
  for (int y = 0; y < truth.height_px; ++y) {
    for (int x = 0; x < truth.width_px; ++x) {
      if (x % block_px == 0 && y % block_px == 0 &&
          has_contrast(truth, x, y, block_px, kContrast)) {
        crossed += 1.0;
      }
      const int side_px = 1 << static_cast<int>(level.at(x, y));
      const bool is_corner = x % side_px == 0 && y % side_px == 0;
      if (is_corner && side_px > 4 && has_contrast(truth, x, y, side_px, kContrast)) missed += 1.0;
    }
  }
  return missed / crossed;
}

}  // namespace renderers::test

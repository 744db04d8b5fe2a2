#pragma once

#include <array>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace renderers::final_gather {

/// Irradiance for every normal, from radiance of directions, by nine spherical harmonics.
///
/// Source: Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment
/// Maps", doi:10.1145/383259.383317, Eqs. 3 and 7 to 10 (numbers recalled): E = sum A_l L_lm Y_lm
/// with A = pi, 2 pi / 3, pi / 4; error below 3 % of the peak for distant light.
class DirectionalIrradiance {
 public:
  /// @param direction  unit length, from where the light comes
  /// @param radiance_sr  radiance times the solid angle it stands for
  void add(const glm::vec3& direction, const glm::vec3& radiance_sr) {
    const auto basis = harmonics(direction);
    for (std::size_t i = 0; i < basis.size(); ++i) {
      coefficients_[i] += basis[i] * kWidths[i] * radiance_sr;
    }
  }
  /// W/m2, never below 0. @param normal  unit length
  glm::vec3 at(const glm::vec3& normal) const {
    const auto basis = harmonics(normal);
    glm::vec3 sum(0.0F);
    for (std::size_t i = 0; i < basis.size(); ++i) sum += basis[i] * coefficients_[i];
    return glm::max(sum, glm::vec3(0.0F));
  }

 private:
  static constexpr float kBand0 = 3.14159265F;
  static constexpr float kBand1 = 2.0F * kBand0 / 3.0F;
  static constexpr float kBand2 = kBand0 / 4.0F;
  static constexpr std::array<float, 9> kWidths{kBand0, kBand1, kBand1, kBand1, kBand2,
                                                kBand2, kBand2, kBand2, kBand2};

  static std::array<float, 9> harmonics(const glm::vec3& d) {
    return {0.282095F,
            0.488603F * d.y,
            0.488603F * d.z,
            0.488603F * d.x,
            1.092548F * d.x * d.y,
            1.092548F * d.y * d.z,
            0.315392F * (3.0F * d.z * d.z - 1.0F),
            1.092548F * d.x * d.z,
            0.546274F * (d.x * d.x - d.y * d.y)};
  }

  std::array<glm::vec3, 9> coefficients_{};
};

}  // namespace renderers::final_gather

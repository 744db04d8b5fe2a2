#include "perception/color_conversion.h"
#include "renderers/scene/scene_file.h"
#include "tests/places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>

/// The colours of the catalogue's Cornell box, derived anew from the measured spectra: "Cornell Box
/// Data", Cornell University Program of Computer Graphics,
/// graphics.cornell.edu/online/box/data.html.
namespace renderers::scene {
namespace {

/// Reflectance at 400, 404, ..., 700 nm.
constexpr std::array<double, 76> kWhite{
    0.343, 0.445, 0.551, 0.624, 0.665, 0.687, 0.708, 0.723, 0.715, 0.71,  0.745, 0.758, 0.739,
    0.767, 0.777, 0.765, 0.751, 0.745, 0.748, 0.729, 0.745, 0.757, 0.753, 0.75,  0.746, 0.747,
    0.735, 0.732, 0.739, 0.734, 0.725, 0.721, 0.733, 0.725, 0.732, 0.743, 0.744, 0.748, 0.728,
    0.716, 0.733, 0.726, 0.713, 0.74,  0.754, 0.764, 0.752, 0.736, 0.734, 0.741, 0.74,  0.732,
    0.745, 0.755, 0.751, 0.744, 0.731, 0.733, 0.744, 0.731, 0.712, 0.708, 0.729, 0.73,  0.727,
    0.707, 0.703, 0.729, 0.75,  0.76,  0.751, 0.739, 0.724, 0.73,  0.74,  0.737};
constexpr std::array<double, 76> kGreen{
    0.092, 0.096, 0.098, 0.097, 0.098, 0.095, 0.095, 0.097, 0.095, 0.094, 0.097, 0.098, 0.096,
    0.101, 0.103, 0.104, 0.107, 0.109, 0.112, 0.115, 0.125, 0.14,  0.16,  0.187, 0.229, 0.285,
    0.343, 0.39,  0.435, 0.464, 0.472, 0.476, 0.481, 0.462, 0.447, 0.441, 0.426, 0.406, 0.373,
    0.347, 0.337, 0.314, 0.285, 0.277, 0.266, 0.25,  0.23,  0.207, 0.186, 0.171, 0.16,  0.148,
    0.141, 0.136, 0.13,  0.126, 0.123, 0.121, 0.122, 0.119, 0.114, 0.115, 0.117, 0.117, 0.118,
    0.12,  0.122, 0.128, 0.132, 0.139, 0.144, 0.146, 0.15,  0.152, 0.157, 0.159};
constexpr std::array<double, 76> kRed{
    0.04,  0.046, 0.048, 0.053, 0.049, 0.05,  0.053, 0.055, 0.057, 0.056, 0.059, 0.057, 0.061,
    0.061, 0.06,  0.062, 0.062, 0.062, 0.061, 0.062, 0.06,  0.059, 0.057, 0.058, 0.058, 0.058,
    0.056, 0.055, 0.056, 0.059, 0.057, 0.055, 0.059, 0.059, 0.058, 0.059, 0.061, 0.061, 0.063,
    0.063, 0.067, 0.068, 0.072, 0.08,  0.09,  0.099, 0.124, 0.154, 0.192, 0.255, 0.287, 0.349,
    0.402, 0.443, 0.487, 0.513, 0.558, 0.584, 0.62,  0.606, 0.609, 0.651, 0.612, 0.61,  0.65,
    0.638, 0.627, 0.62,  0.63,  0.628, 0.642, 0.639, 0.657, 0.639, 0.635, 0.642};

/// CIE 1931 standard observer and CIE standard illuminant D65 at 400, 410, ..., 700 nm (CIE 15).
constexpr std::array<double, 31> kObserverX{
    0.01431, 0.04351, 0.13438, 0.2839, 0.34828, 0.3362, 0.2908,  0.19536, 0.09564, 0.03201, 0.0049,
    0.0093,  0.06327, 0.1655,  0.2904, 0.43345, 0.5945, 0.7621,  0.9163,  1.0263,  1.0622,  1.0026,
    0.85445, 0.6424,  0.4479,  0.2835, 0.1649,  0.0874, 0.04677, 0.0227,  0.011359};
constexpr std::array<double, 31> kObserverY{
    0.000396, 0.00121, 0.004, 0.0116, 0.023,   0.038, 0.06,  0.09098, 0.13902, 0.20802, 0.323,
    0.503,    0.71,    0.862, 0.954,  0.99495, 0.995, 0.952, 0.87,    0.757,   0.631,   0.503,
    0.381,    0.265,   0.175, 0.107,  0.061,   0.032, 0.017, 0.00821, 0.004102};
constexpr std::array<double, 31> kObserverZ{
    0.06785, 0.2074,  0.6456,  1.3856, 1.74706, 1.77211, 1.6692, 1.28764, 0.81295, 0.46518, 0.272,
    0.1582,  0.07825, 0.04216, 0.0203, 0.00875, 0.0039,  0.0021, 0.00165, 0.0011,  0.0008,  0.00034,
    0.00019, 5e-05,   2e-05,   0,      0,       0,       0,      0,       0};
constexpr std::array<double, 31> kD65{82.7549, 91.486,  93.4318, 86.6823, 104.865, 117.008, 117.812,
                                      114.861, 115.923, 108.811, 109.354, 107.802, 104.79,  107.689,
                                      104.405, 104.046, 100.0,   96.3342, 95.788,  88.6856, 90.0062,
                                      89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778,
                                      78.2842, 69.7213, 71.6091};

constexpr int kStepNm = 4;

/// A table of 10 nm steps at a wavelength, linear between.
double at_nm(const std::array<double, 31>& table, int wavelength_nm) {
  const double position = (wavelength_nm - 400) / 10.0;
  const auto first = std::min<std::size_t>(static_cast<std::size_t>(position), 29);
  const double weight = position - static_cast<double>(first);
  return table[first] * (1.0 - weight) + table[first + 1] * weight;
}

double equal_energy(int) { return 1.0; }
double d65(int wavelength_nm) { return at_nm(kD65, wavelength_nm); }
double perfect_reflector(std::size_t) { return 1.0; }

/// Emission of the lamp: 0, 8.0, 15.6, 18.4 at 400, 500, 600, 700 nm.
double lamp(std::size_t index) {
  constexpr std::array<double, 4> kLamp{0.0, 8.0, 15.6, 18.4};
  const double position = static_cast<double>(index) * kStepNm / 100.0;
  const auto first = std::min<std::size_t>(static_cast<std::size_t>(position), 2);
  return std::lerp(kLamp[first], kLamp[first + 1], position - static_cast<double>(first));
}

template <typename Spectrum, typename Illuminant>
std::array<double, 3> xyz_of(Spectrum&& spectrum, Illuminant&& illuminant) {
  std::array<double, 3> xyz{};
  for (std::size_t i = 0; i < kWhite.size(); ++i) {
    const int wavelength_nm = 400 + static_cast<int>(i) * kStepNm;
    const double light = spectrum(i) * illuminant(wavelength_nm);
    xyz[0] += light * at_nm(kObserverX, wavelength_nm);
    xyz[1] += light * at_nm(kObserverY, wavelength_nm);
    xyz[2] += light * at_nm(kObserverZ, wavelength_nm);
  }
  return xyz;
}

std::array<float, 3> rgb_of(const std::array<double, 3>& xyz, double scale) {
  return perception::linear_rgb_from_xyz({static_cast<float>(xyz[0] * scale),
                                          static_cast<float>(xyz[1] * scale),
                                          static_cast<float>(xyz[2] * scale)});
}

Material material(const std::string& name) {
  static const Scene scene = read_scene_file(std::filesystem::path(tests::kSourceFolder) /
                                             "suites/scenes/cornell-box.yaml")
                                 .at_frame(0);
  for (const Material& candidate : scene.materials) {
    if (candidate.name == name) return candidate;
  }
  ADD_FAILURE() << "no material " << name;
  return {};
}

void expect_reflectance(const std::string& name, const std::array<double, 76>& reflectance) {
  const auto white_xyz = xyz_of(perfect_reflector, d65);
  const auto white_rgb = rgb_of(white_xyz, 1.0 / white_xyz[1]);
  const auto rgb =
      rgb_of(xyz_of([&](std::size_t i) { return reflectance[i]; }, d65), 1.0 / white_xyz[1]);
  const glm::vec3 albedo = material(name).albedo;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(albedo[static_cast<int>(i)], rgb[i] / white_rgb[i], 1e-3F) << name << " " << i;
  }
}

TEST(CornellData, ReflectancesComeFromTheSpectra) {
  expect_reflectance("white", kWhite);
  expect_reflectance("green", kGreen);
  expect_reflectance("red", kRed);
}

TEST(CornellData, LampComesFromItsSpectrum) {
  const auto rgb =
      rgb_of(xyz_of(lamp, equal_energy), 1.0 / xyz_of(perfect_reflector, equal_energy)[1]);
  // The catalogue's lamp is three times as strong, as its file says.
  const glm::vec3 emission = material("lamp").emission / 3.0F;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(emission[static_cast<int>(i)], rgb[i], 0.02F) << i;
  }
}

}  // namespace
}  // namespace renderers::scene

#pragma once

#include <array>

#include "perception/image.h"

namespace perception {

/// IEC 61966-2-1 sRGB transfer, per value; odd-symmetric below 0, unbounded above 1.
float srgb_encode(float linear);
float srgb_decode(float encoded);

/// Linear Rec.709 luminance weights, ITU-R BT.709: 0.2126, 0.7152, 0.0722.
inline constexpr std::array<float, 3> kRec709Luma{0.2126F, 0.7152F, 0.0722F};

/// Linear Rec.709 -> CIE XYZ (D65), exact fractions as in FLIP (Andersson et al. 2020).
std::array<float, 3> xyz_from_linear_rgb(std::array<float, 3> rgb);
std::array<float, 3> linear_rgb_from_xyz(std::array<float, 3> xyz);

/// CIE 1976 L*a*b* of XYZ relative to the D65 white of `xyz_from_linear_rgb({1,1,1})`.
std::array<float, 3> lab_from_xyz(std::array<float, 3> xyz);
std::array<float, 3> xyz_from_lab(std::array<float, 3> lab);

/// Applies the transfer to R, G, B of a whole image and changes its encoding.
Image srgb_encoded(const Image& linear);   ///< scene_linear -> display, values are not clamped
Image srgb_decoded(const Image& display);  ///< display -> scene_linear

/// Linear R, G, B of an image whatever its encoding (display is decoded).
Image linear_rgb_of(const Image& image);

}  // namespace perception

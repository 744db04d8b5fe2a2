#pragma once

#include "perception/image.h"
#include "perception/viewing_conditions.h"

namespace perception {

/// The light that leaves the screen, linear Rec.709 R, G, B in cd/m2 (or one channel Y).
///
/// scene_linear: radiance x 2^exposure_ev x luminance_scale_cd_m2, clipped to what the display can
/// show, [max(0.005, black), peak], plus the reflected light; the transfer plays no part.
/// display: the signal, clipped to [0, 1], through the display's transfer, plus reflected light.
/// srgb and bt1886 signals have the primaries of BT.709, pq and hlg those of BT.2020, so that
/// saturated colours may come out with a negative component.
/// luminance_cd_m2: unchanged, it is light already.
/// Reflected light: ambient_lux x screen_reflectance / pi. Non-finite values stay as they are.
/// @return encoding luminance_cd_m2; R, G, B, or Y for an image with one channel
/// @throws base::InputError for a display-encoded image with the transfer linear_hdr
/// Source: Mantiuk et al. 2024, "ColorVideoVDP", and its reference code; for srgb:
/// L = (peak - black) EOTF(V) + black + reflected.
Image to_display_light(const Image& image, const ViewingConditions& viewing);

/// The sRGB-encoded picture that an SDR viewer shows: clamp(2^ev x linear) encoded; display stays.
///
/// Non-finite values stay as they are. @param exposure_ev  stops
/// @throws base::InputError for encoding luminance_cd_m2
Image to_display_encoded(const Image& image, double exposure_ev);

}  // namespace perception

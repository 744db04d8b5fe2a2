#pragma once

#include <array>
#include <string>

namespace perception {

/// Linear Rec.709 to ACES2065-1, 4x4 row by row, computed from the primaries and whites of ITU-R
/// BT.709 and SMPTE ST 2065-1 with Bradford adaptation.
inline constexpr std::array<double, 16> kAcesFromRec709{0.439632981919,
                                                        0.382988698152,
                                                        0.177378319929,
                                                        0.0,  //
                                                        0.089776442959,
                                                        0.813439428749,
                                                        0.096784128292,
                                                        0.0,  //
                                                        0.017541170383,
                                                        0.111546553302,
                                                        0.870912276314,
                                                        0.0,  //
                                                        0.0,
                                                        0.0,
                                                        0.0,
                                                        1.0};

/// An OpenColorIO 2 configuration, as text, with the ACES output transforms that OpenColorIO has
/// built in. Reference space: ACES2065-1. Internal: use color_management.h.
std::string aces_config();

}  // namespace perception

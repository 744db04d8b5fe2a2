#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>

/// Convolution (soft) shadow maps of area lights in double precision, and the brute force that they
/// approximate, written for clarity, not for speed.
///
/// Dong, Grosch, Ritschel, Kautz, Seidel 2009, "Real-time Indirect Illumination with Clustered
/// Visibility", Sec. 4.1 and 4.2. The coefficients of the series and what the paper leaves open are
/// marked "derived": they follow from the Fourier series of a square wave.
///
/// d is a receiver's distance to the area light's centre, z a stored distance; both divided by a
/// range that keeps them within 0.9. t = z - d; the receiver is lit where t >= 0.
namespace test_clustered_visibility {

// The series.

/// The step as a truncated and damped Fourier series; derived.
struct ConvolutionSeries {
  int terms = 4;         ///< K
  double damping = 0.5;  ///< a; 0: none
};

/// c_k = pi (2k - 1), k from 1.
double series_frequency(int k);

/// exp(-a (k / K)^2), k from 1.
double series_damping(const ConvolutionSeries& series, int k);

/// S(t) = 1/2 + 2 sum_k damp_k / c_k sin(c_k t): near 1 for t in (0, 1), near 0 for t in (-1, 0),
/// 1/2 at 0; of period 2, and S(1 - t) = S(t). Overshoots both ends.
double series_step(const ConvolutionSeries& series, double t);

/// What makes lit surfaces white, as S is 1/2 at t = 0; derived.
enum class StepFix {
  scale,   ///< clamp(2 S(t), 0, 1)
  offset,  ///< clamp(S(t + 1 / (2K)), 0, 1)
};

/// 1 / (2K): where the undamped series has its first overshoot.
double series_offset(const ConvolutionSeries& series);

/// Lit fraction of one texel, [0, 1].
double fixed_step(const ConvolutionSeries& series, StepFix fix, double t);

// Kernels, and filtering before the comparison.

struct KernelTexel {
  double z = 0.0;
  double weight = 0.0;  ///< share of the kernel
};
using Kernel = std::vector<KernelTexel>;  ///< weights sum to 1

/// Filtered basis images [w * B](p) of Sec. 4.1 and the basis-z images of Sec. 6; entry k - 1
/// belongs to term k. The filtered z is needed for the constant 1/2 of the series (derived).
struct BasisMeans {
  std::vector<double> sine;      ///< of sin(c_k z)
  std::vector<double> cosine;    ///< of cos(c_k z)
  std::vector<double> z_sine;    ///< of z sin(c_k z)
  std::vector<double> z_cosine;  ///< of z cos(c_k z)
  double z = 0.0;
};
BasisMeans basis_means(const ConvolutionSeries& series, const Kernel& kernel);

/// Kernel mean of S(z - d), from the filtered basis alone.
double filtered_step(const ConvolutionSeries& series, const BasisMeans& means, double d);

/// Lit fraction of a kernel, [0, 1]: the fix applied to the mean.
double filtered_visibility(const ConvolutionSeries& series, const BasisMeans& means, double d,
                           StepFix fix);

// Average blocker depth.

/// Kernel means with fbar = 1 - S(z - d), from the filtered basis alone; derived.
struct BlockerSums {
  double numerator = 0.0;    ///< A, mean of fbar z
  double denominator = 0.0;  ///< B, mean of fbar; ripples may make it negative
};
BlockerSums blocker_sums(const ConvolutionSeries& series, const BasisMeans& means, double d);

/// A / B, whatever B is; too near to d, as unblocked texels at d count half.
double raw_blocker_depth(const BlockerSums& sums);

/// Blocked fraction below which a receiver is lit, of either convention; derived.
inline constexpr double kLeastBlockedFraction = 0.05;

/// Average depth of blockers in the convention of a fix (derived), nothing where lit.
///
/// scale: f = 2B - 1, z = (A - (1 - B) d) / f; exact for an ideal step and unblocked texels at d.
/// Wrong, and possibly negative, where these are farther away.
/// offset: d - 1 / (2K) in place of d in A and B, f = B, z = A / B; the overshoot at unblocked
/// texels biases it where f is small.
/// The result is not clamped and may lie outside (0, d).
std::optional<double> corrected_blocker_depth(const ConvolutionSeries& series,
                                              const BasisMeans& means, double d, StepFix fix);

// Widths of kernels.

/// Full angle of the region searched for blockers, rad: multiplier atan(sqrt(A cos) / d).
/// The paper only says that it follows from the light's solid angle (Sec. 4.2): this choice is
/// derived. With cos = 1 it equals kernel_angle_rad of a blocker halfway.
/// @param area_m2       of the light
/// @param cos_at_light  of its normal to the receiver's direction, [0, 1]
/// @param distance_m    of the receiver, > 0
double search_angle_rad(double multiplier, double area_m2, double cos_at_light, double distance_m);

/// p cos(beta) = (d - z) Delta / z, Sec. 4.2: width of the penumbra across the ray.
/// @param d, z, size  > 0, in one unit, which is the result's
double penumbra_width(double d, double z, double size);

/// alpha = atan(p cos(beta) / d), Sec. 4.2: full angle of the penumbra at the light, rad.
double kernel_angle_rad(double d, double z, double size);

/// alpha / pi, Sec. 4.2: width in uv, where the map's square is [0, 1]^2.
double paper_kernel_width_uv(double angle_rad);

/// alpha (1 + r^2) / 4: as the projection is conformal, right for small angles; derived.
/// @param map_radius  of the receiver's direction: 0 on the axis, 1 at the rim
double conformal_kernel_width_uv(double angle_rad, double map_radius);

/// Diameter in uv of the circle that a cone of full angle alpha becomes; derived.
/// @param polar_rad  angle of the cone's axis to the light's normal; polar + alpha / 2 < pi
double exact_kernel_width_uv(double angle_rad, double polar_rad);

// Brute force.

struct DepthMap {
  int size_px = 0;
  std::vector<double> z;  ///< size_px^2, row by row; texel (x, y) covers [x, x + 1] / size_px in u
};

/// Box of a width around a point, texels weighted by the part of them that it covers; what lies
/// outside the map does not count.
/// @param width_uv  > 0, the box must touch the map's inside
Kernel box_kernel(const DepthMap& map, const glm::dvec2& center_uv, double width_uv);

/// Percentage-closer filtering, Sec. 4.1: mean of (d <= z), [0, 1].
double exact_visibility(const Kernel& kernel, double d);

/// Mean z of texels with z < d, nothing if there are none.
std::optional<double> exact_blocker_depth(const Kernel& kernel, double d);

// Closed forms for a kernel over two planes; derived.

struct TwoPlanes {
  double blocked_fraction = 0.0;  ///< f
  double z_blocker = 0.0;
  double z_background = 0.0;
};
Kernel two_plane_kernel(const TwoPlanes& planes);

/// A and B as sums of two values of S.
BlockerSums two_plane_sums(const ConvolutionSeries& series, const TwoPlanes& planes, double d);

/// Raw average for an ideal step and a background at d:
/// (f z_b + (1 - f) d / 2) / (f + (1 - f) / 2).
double two_plane_raw_depth(double blocked_fraction, double z_blocker, double d);

/// What the scale convention gives for a background at d, whatever f is: with S = S(z_b - d),
/// z_b - (d - z_b) S / (1 - 2 S).
double two_plane_scale_depth(const ConvolutionSeries& series, double z_blocker, double d);

}  // namespace test_clustered_visibility

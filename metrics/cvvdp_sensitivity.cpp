#include "metrics/cvvdp_sensitivity.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace metrics {
namespace {

/// Nodes of the full table that are kept, and the table's frequencies.
constexpr std::array<int, 11> kKeptLuminances{0, 3, 6, 9, 12, 15, 18, 21, 24, 27, 31};
constexpr std::array<int, 15> kKeptFrequencies{0,  3,  6,  9,  11, 13, 15, 17,
                                               19, 21, 23, 25, 27, 29, 31};
constexpr std::size_t kFrequencies = 32;
constexpr double kLowest_cpd = 0.1;
constexpr double kHighest_cpd = 64.0;

constexpr std::size_t kRedGreen = 1;

/// Where the full table would fall below a sensitivity of 1 in the red-green channel it says 0.2.
constexpr double kRedGreenFloor = -0.69897;

using KeptRow = std::array<double, kKeptFrequencies.size()>;
using KeptTable = std::array<KeptRow, kKeptLuminances.size()>;

/// log10 of the sensitivity, a row per luminance.
constexpr std::array<KeptTable, kCvvdpChannels> kKept{{
    // achromatic
    {{
        {0.5404, 0.8566, 1.0259, 1.0449, 0.9713, 0.8239, 0.5947, 0.2726, -0.1508, -0.6743, -1.2882,
         -1.9818, -2.7479, -3.5812, -4.4462},
        {0.6406, 0.9482, 1.2022, 1.3059, 1.2887, 1.1978, 1.0250, 0.7594, 0.3924, -0.0746, -0.6321,
         -1.2692, -1.9789, -2.7573, -3.6007},
        {0.7407, 1.0119, 1.3298, 1.5181, 1.5573, 1.5228, 1.4064, 1.1972, 0.8867, 0.4760, -0.0250,
         -0.6058, -1.2591, -1.9812, -2.7701},
        {0.8405, 1.1118, 1.4087, 1.6813, 1.7768, 1.7984, 1.7383, 1.5853, 1.3309, 0.9764, 0.5316,
         0.0071, -0.5900, -1.2559, -1.9888},
        {0.9395, 1.2107, 1.4811, 1.7956, 1.9465, 2.0234, 2.0186, 1.9210, 1.7220, 1.4229, 1.0335,
         0.5643, 0.0225, -0.5880, -1.2656},
        {1.0349, 1.3061, 1.5765, 1.8626, 2.0657, 2.1949, 2.2423, 2.1970, 2.0502, 1.8033, 1.4661,
         1.0492, 0.5597, 0.0014, -0.6239},
        {1.1183, 1.3896, 1.6600, 1.9276, 2.1377, 2.3096, 2.3998, 2.3972, 2.2932, 2.0891, 1.7946,
         1.4204, 0.9736, 0.4581, -0.1245},
        {1.1746, 1.4458, 1.7162, 1.9839, 2.1741, 2.3713, 2.4866, 2.5092, 2.4303, 2.2514, 1.9821,
         1.6331, 1.2115, 0.7211, 0.1637},
        {1.1995, 1.4707, 1.7412, 2.0088, 2.1889, 2.3957, 2.5207, 2.5529, 2.4838, 2.3145, 2.0549,
         1.7155, 1.3036, 0.8229, 0.2752},
        {1.1975, 1.4688, 1.7392, 2.0069, 2.1837, 2.3933, 2.5211, 2.5561, 2.4897, 2.3232, 2.0664,
         1.7298, 1.3207, 0.8427, 0.2978},
        {0.8568, 1.1280, 1.3984, 1.6661, 1.8420, 2.0524, 2.1810, 2.2168, 2.1512, 1.9855, 1.7295,
         1.3937, 0.9854, 0.5082, -0.0359},
    }},
    // red-green
    {{
        {0.4612, 0.5740, 0.6651, 0.7230, 0.7306, 0.7005, 0.6265, 0.5127, 0.3699, 0.2079, 0.0329,
         -0.6990, -0.6990, -0.6990, -0.6990},
        {0.7579, 0.8707, 0.9618, 1.0198, 1.0273, 0.9973, 0.9232, 0.8094, 0.6666, 0.5047, 0.3296,
         0.1446, -0.6990, -0.6990, -0.6990},
        {1.0544, 1.1672, 1.2583, 1.3162, 1.3238, 1.2937, 1.2197, 1.1059, 0.9631, 0.8011, 0.6261,
         0.4410, 0.2475, 0.0461, -0.6990},
        {1.3497, 1.4626, 1.5536, 1.6116, 1.6191, 1.5891, 1.5151, 1.4013, 1.2584, 1.0965, 0.9214,
         0.7364, 0.5429, 0.3415, 0.1325},
        {1.6407, 1.7536, 1.8446, 1.9026, 1.9101, 1.8801, 1.8061, 1.6922, 1.5494, 1.3875, 1.2124,
         1.0274, 0.8338, 0.6324, 0.4235},
        {1.9154, 2.0282, 2.1193, 2.1772, 2.1847, 2.1547, 2.0807, 1.9669, 1.8241, 1.6621, 1.4870,
         1.3020, 1.1085, 0.9071, 0.6981},
        {2.1402, 2.2530, 2.3441, 2.4020, 2.4096, 2.3795, 2.3055, 2.1917, 2.0489, 1.8869, 1.7119,
         1.5269, 1.3333, 1.1319, 0.9230},
        {2.2728, 2.3856, 2.4767, 2.5346, 2.5422, 2.5121, 2.4381, 2.3243, 2.1815, 2.0195, 1.8445,
         1.6594, 1.4659, 1.2645, 1.0555},
        {2.3237, 2.4366, 2.5276, 2.5856, 2.5931, 2.5631, 2.4891, 2.3753, 2.2324, 2.0705, 1.8954,
         1.7104, 1.5169, 1.3155, 1.1065},
        {2.3384, 2.4512, 2.5423, 2.6002, 2.6078, 2.5777, 2.5037, 2.3899, 2.2471, 2.0851, 1.9101,
         1.7250, 1.5315, 1.3301, 1.1211},
        {2.3426, 2.4554, 2.5465, 2.6044, 2.6120, 2.5819, 2.5079, 2.3941, 2.2513, 2.0893, 1.9143,
         1.7293, 1.5357, 1.3343, 1.1254},
    }},
    // violet-yellow
    {{
        {0.0593, 0.1953, 0.3038, 0.3686, 0.3718, 0.3315, 0.2470, 0.1269, -0.0177, -0.1791, -0.3528,
         -0.5369, -0.7304, -0.9329, -1.1442},
        {0.2971, 0.4330, 0.5415, 0.6063, 0.6095, 0.5693, 0.4848, 0.3647, 0.2201, 0.0587, -0.1151,
         -0.2992, -0.4927, -0.6951, -0.9064},
        {0.5347, 0.6707, 0.7792, 0.8440, 0.8472, 0.8069, 0.7224, 0.6023, 0.4577, 0.2963, 0.1226,
         -0.0615, -0.2550, -0.4575, -0.6687},
        {0.7719, 0.9079, 1.0164, 1.0812, 1.0844, 1.0441, 0.9596, 0.8395, 0.6949, 0.5335, 0.3598,
         0.1757, -0.0178, -0.2203, -0.4316},
        {1.0073, 1.1432, 1.2517, 1.3165, 1.3197, 1.2795, 1.1949, 1.0749, 0.9302, 0.7689, 0.5951,
         0.4110, 0.2175, 0.0150, -0.1962},
        {1.2354, 1.3714, 1.4799, 1.5447, 1.5479, 1.5077, 1.4231, 1.3031, 1.1584, 0.9971, 0.8233,
         0.6392, 0.4457, 0.2432, 0.0320},
        {1.4389, 1.5749, 1.6834, 1.7482, 1.7514, 1.7112, 1.6266, 1.5065, 1.3619, 1.2006, 1.0268,
         0.8427, 0.6492, 0.4467, 0.2355},
        {1.5823, 1.7182, 1.8267, 1.8915, 1.8947, 1.8545, 1.7700, 1.6499, 1.5053, 1.3439, 1.1701,
         0.9860, 0.7925, 0.5901, 0.3788},
        {1.6493, 1.7853, 1.8938, 1.9586, 1.9618, 1.9216, 1.8370, 1.7169, 1.5723, 1.4110, 1.2372,
         1.0531, 0.8596, 0.6571, 0.4459},
        {1.6708, 1.8068, 1.9153, 1.9801, 1.9833, 1.9431, 1.8585, 1.7385, 1.5938, 1.4325, 1.2587,
         1.0746, 0.8811, 0.6786, 0.4674},
        {1.6773, 1.8132, 1.9217, 1.9865, 1.9898, 1.9495, 1.8650, 1.7449, 1.6003, 1.4389, 1.2651,
         1.0810, 0.8875, 0.6851, 0.4738},
    }},
}};

/// A cubic spline through points one apart or more, whose outermost two pieces on each side are one
/// polynomial ("not a knot").
class Spline {
 public:
  /// @param x, y  at least 4 points, x rising
  Spline(std::vector<double> x, std::vector<double> y)
      : x_(std::move(x)), y_(std::move(y)), curvatures_(x_.size(), 0.0) {
    find_curvatures();
  }

  double at(double x) const {
    const auto above = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
    const auto j = static_cast<std::size_t>(above - x_.begin()) - 1;
    const double h = step(j);
    const double t = (x - x_[j]) / h;
    const double u = 1.0 - t;
    return u * y_[j] + t * y_[j + 1] +
           h * h / 6.0 * ((u * u * u - u) * curvatures_[j] + (t * t * t - t) * curvatures_[j + 1]);
  }

 private:
  double step(std::size_t i) const { return x_[i + 1] - x_[i]; }

  /// Second derivatives at the points, by elimination in a tridiagonal system.
  void find_curvatures() {
    const std::size_t last = x_.size() - 1;
    std::vector<double> diagonal(last + 1), right(last + 1), value(last + 1);
    for (std::size_t i = 1; i < last; ++i) {
      const double before = step(i - 1), after = step(i);
      double left = before;
      diagonal[i] = 2.0 * (before + after);
      right[i] = after;
      value[i] = 6.0 * ((y_[i + 1] - y_[i]) / after - (y_[i] - y_[i - 1]) / before);
      // The curvature at an end continues the line through its two neighbours'.
      if (i == 1) {
        diagonal[i] += before * (before + after) / after;
        right[i] -= before * before / after;
        continue;
      }
      if (i == last - 1) {
        diagonal[i] += after * (before + after) / before;
        left -= after * after / before;
      }
      const double factor = left / diagonal[i - 1];
      diagonal[i] -= factor * right[i - 1];
      value[i] -= factor * value[i - 1];
    }
    curvatures_[last - 1] = value[last - 1] / diagonal[last - 1];
    for (std::size_t i = last - 1; i-- > 1;) {
      curvatures_[i] = (value[i] - right[i] * curvatures_[i + 1]) / diagonal[i];
    }
    curvatures_[0] = curvatures_[1] - (curvatures_[2] - curvatures_[1]) * step(0) / step(1);
    curvatures_[last] = curvatures_[last - 1] + (curvatures_[last - 1] - curvatures_[last - 2]) *
                                                    step(last - 1) / step(last - 2);
  }

  std::vector<double> x_, y_, curvatures_;
};

/// The red-green surface is a function of luminance plus one of frequency: nodes where the table
/// says 0.2 are filled with that sum, so that the spline is smooth.
KeptTable without_floor(KeptTable kept) {
  const KeptRow& brightest = kept.back();
  for (KeptRow& row : kept) {
    for (std::size_t f = 0; f < row.size(); ++f) {
      if (row[f] < kRedGreenFloor + 0.01) row[f] = row[0] + brightest[f] - brightest[0];
    }
  }
  return kept;
}

/// Position of a value among logarithmic steps, held within them.
double position_among(double value, double lowest, double highest, std::size_t count) {
  const auto last = static_cast<double>(count - 1);
  return std::clamp(std::log(value / lowest) / std::log(highest / lowest) * last, 0.0, last);
}

/// Linear interpolation between consecutive nodes: weights 1 - share and share.
struct Between {
  std::size_t below;
  double share;
};
Between between(double position, std::size_t count) {
  const auto below = std::min(static_cast<std::size_t>(position), count - 2);
  return {below, position - static_cast<double>(below)};
}

}  // namespace

CvvdpSensitivity::CvvdpSensitivity() {
  const std::vector<double> luminances(kKeptLuminances.begin(), kKeptLuminances.end());
  const std::vector<double> frequencies(kKeptFrequencies.begin(), kKeptFrequencies.end());
  for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
    const KeptTable kept = c == kRedGreen ? without_floor(kKept[c]) : kKept[c];
    std::vector<Spline> along_frequency;
    for (const KeptRow& row : kept) {
      along_frequency.emplace_back(frequencies, std::vector<double>(row.begin(), row.end()));
    }
    tables_[c].resize(kFrequencies);
    for (std::size_t f = 0; f < kFrequencies; ++f) {
      std::vector<double> column;
      for (const Spline& spline : along_frequency) {
        column.push_back(spline.at(static_cast<double>(f)));
      }
      const Spline along_luminance(luminances, column);
      for (std::size_t l = 0; l < kCvvdpLuminances; ++l) {
        const double value = along_luminance.at(static_cast<double>(l));
        tables_[c][f][l] = c == kRedGreen && value < 0.0 ? kRedGreenFloor : value;
      }
    }
  }
}

CvvdpSensitivityCurves CvvdpSensitivity::at(double frequency_cpd) const {
  const Between node =
      between(position_among(frequency_cpd, kLowest_cpd, kHighest_cpd, kFrequencies), kFrequencies);
  CvvdpSensitivityCurves curves;
  for (std::size_t c = 0; c < kCvvdpChannels; ++c) {
    const auto& below = tables_[c][node.below];
    const auto& above = tables_[c][node.below + 1];
    for (std::size_t l = 0; l < kCvvdpLuminances; ++l) {
      curves[c][l] = below[l] + node.share * (above[l] - below[l]);
    }
  }
  return curves;
}

double cvvdp_sensitivity_of(const std::array<double, kCvvdpLuminances>& curve,
                            double luminance_cd_m2) {
  const Between node = between(
      position_among(luminance_cd_m2, kCvvdpLowest_cd_m2, kCvvdpHighest_cd_m2, kCvvdpLuminances),
      kCvvdpLuminances);
  return std::pow(10.0,
                  curve[node.below] + node.share * (curve[node.below + 1] - curve[node.below]));
}

}  // namespace metrics

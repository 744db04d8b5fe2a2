#include "perception/fourier_filter.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>

#include <opencv2/core.hpp>

#include "perception/base/parallel.h"

namespace perception {
namespace {

using Complex = std::complex<float>;

/// Rows, or columns, that one piece of a parallel loop transforms.
constexpr std::size_t kPiece = 16;

/// Mirrored pixels beyond the image: two periods of the cortex transform's coarsest level.
constexpr int kMargin_px = 64;

/// Index of the pixel that a mirrored line shows at position i, which may be outside.
int mirrored(int i, int size_px) {
  const int period = 2 * size_px;
  const int place = (i % period + period) % period;
  return place < size_px ? place : period - 1 - place;
}

int even_transform_size(int size_px) { return 2 * cv::getOptimalDFTSize((size_px + 1) / 2); }

}  // namespace

std::vector<FourierFilter::Continuation> FourierFilter::continuations(int size_px, int padded_px) {
  std::vector<Continuation> beyond;
  const int count = padded_px - size_px;
  for (int j = 0; j < count; ++j) {
    const double t = (j + 0.5) / count;
    const double smooth_step = t * t * (3.0 - 2.0 * t);
    beyond.push_back({mirrored(size_px + j, size_px), mirrored(j - count, size_px),
                      static_cast<float>(smooth_step)});
  }
  return beyond;
}

FourierFilter::FourierFilter(int width_px, int height_px)
    : width_px_(width_px),
      height_px_(height_px),
      padded_width_px_(even_transform_size(width_px + kMargin_px)),
      beyond_rows_(continuations(width_px, padded_width_px_)) {
  const int padded_height_px = cv::getOptimalDFTSize(height_px + kMargin_px);
  beyond_columns_ = continuations(height_px, padded_height_px);
  for (int i = 0; i < padded_height_px; ++i) {
    const int cycles = i <= padded_height_px / 2 ? i : i - padded_height_px;
    fy_.push_back(static_cast<float>(cycles) / static_cast<float>(padded_height_px));
  }
}

/// Spectra of an image's rows, and the passes between them, images and whole spectra.
class FourierFilter::Work {
 public:
  explicit Work(const FourierFilter& filter)
      : filter_(filter),
        columns_(filter.column_count()),
        length_(filter.column_length()),
        rows_(std::make_unique_for_overwrite<Complex[]>(
            columns_ * static_cast<std::size_t>(filter.height_px_))),
        is_used_(columns_, 0) {}

  /// Image to rows' spectra.
  void transform_rows(const Image& image) {
    for_each_piece(height(), [&](std::size_t first, std::size_t count) {
      const auto width = static_cast<std::size_t>(filter_.width_px_);
      std::vector<float> strip(count * padded_width());
      for (std::size_t r = 0; r < count; ++r) {
        float* line = strip.data() + r * padded_width();
        std::copy_n(image.pixels.data() + (first + r) * width, width, line);
        continue_line(filter_.beyond_rows_, line, width);
      }
      cv::Mat view = row_view(strip.data(), count);
      cv::dft(view, view, cv::DFT_ROWS);
      for (std::size_t r = 0; r < count; ++r) unpack(strip.data() + r * padded_width(), first + r);
    });
  }

  /// Rows' spectra to the whole spectrum, times the response.
  void transform_columns(const FrequencyResponse& response, Spectrum& spectrum) {
    for_each_piece(columns_, [&](std::size_t first, std::size_t count) {
      Complex* strip = spectrum.data() + first * length_;
      gather(first, count, strip);
      cv::Mat view = column_view(strip, count);
      cv::dft(view, view, cv::DFT_ROWS);
      if (!response) return;
      std::vector<float> gains(length_);
      for (std::size_t c = 0; c < count; ++c) {
        Complex* column = strip + c * length_;
        if (response(fx(first + c), filter_.fy_, gains)) {
          for (std::size_t i = 0; i < length_; ++i) column[i] *= gains[i];
        } else {
          std::fill_n(column, length_, Complex());
        }
      }
    });
  }

  /// The whole spectrum, filtered, to rows' spectra.
  void restore_columns(const Spectrum& spectrum, const FrequencyResponse& response) {
    for_each_piece(columns_, [&](std::size_t first, std::size_t count) {
      std::vector<float> gains(length_);
      std::vector<Complex> strip(count * length_);
      std::vector<std::size_t> used;
      for (std::size_t c = first; c < first + count; ++c) {
        if (!response(fx(c), filter_.fy_, gains)) continue;
        const Complex* column = spectrum.data() + c * length_;
        Complex* target = strip.data() + used.size() * length_;
        for (std::size_t i = 0; i < length_; ++i) target[i] = column[i] * gains[i];
        used.push_back(c);
      }
      restore(strip, used);
    });
  }

  /// Rows' spectra filtered along columns, in place.
  void filter_columns(const FrequencyResponse& response) {
    for_each_piece(columns_, [&](std::size_t first, std::size_t count) {
      std::vector<float> gains(count * length_);
      std::vector<std::size_t> used;
      for (std::size_t c = first; c < first + count; ++c) {
        const std::span<float> own(gains.data() + used.size() * length_, length_);
        if (response(fx(c), filter_.fy_, own)) used.push_back(c);
      }
      if (used.empty()) return;
      std::vector<Complex> strip(count * length_);
      for (std::size_t u = 0; u < used.size(); ++u) {
        gather(used[u], 1, strip.data() + u * length_);
      }
      cv::Mat view = column_view(strip.data(), used.size());
      cv::dft(view, view, cv::DFT_ROWS);
      for (std::size_t i = 0; i < used.size() * length_; ++i) strip[i] *= gains[i];
      restore(strip, used);
    });
  }

  /// Rows' spectra to the image.
  void restore_rows(Image& image) const {
    for_each_piece(height(), [&](std::size_t first, std::size_t count) {
      const auto width = static_cast<std::size_t>(filter_.width_px_);
      std::vector<float> strip(count * padded_width());
      for (std::size_t r = 0; r < count; ++r) pack(first + r, strip.data() + r * padded_width());
      cv::Mat view = row_view(strip.data(), count);
      cv::dft(view, view, cv::DFT_ROWS | cv::DFT_INVERSE | cv::DFT_SCALE);
      for (std::size_t r = 0; r < count; ++r) {
        std::copy_n(strip.data() + r * padded_width(), width,
                    image.pixels.data() + (first + r) * width);
      }
    });
  }

 private:
  std::size_t height() const { return static_cast<std::size_t>(filter_.height_px_); }
  std::size_t padded_width() const { return static_cast<std::size_t>(filter_.padded_width_px_); }
  float fx(std::size_t column) const {
    return static_cast<float>(column) / static_cast<float>(filter_.padded_width_px_);
  }

  template <class Body>
  static void for_each_piece(std::size_t count, const Body& body) {
    base::parallel_for(count, kPiece,
                       [&](std::size_t begin, std::size_t end) { body(begin, end - begin); });
  }

  cv::Mat row_view(float* strip, std::size_t count) const {
    return {static_cast<int>(count), filter_.padded_width_px_, CV_32FC1, strip};
  }
  cv::Mat column_view(Complex* strip, std::size_t count) const {
    return {static_cast<int>(count), static_cast<int>(length_), CV_32FC2, strip};
  }

  template <class Value>
  static void continue_line(const std::vector<Continuation>& beyond, Value* line,
                            std::size_t size) {
    Value* next = line + size;
    for (const Continuation& one : beyond) {
      const Value end = line[one.from_end], begin = line[one.from_begin];
      *next++ = end + one.share_of_begin * (begin - end);
    }
  }

  /// OpenCV's packed spectrum of a row of even length: Re 0, Re 1, Im 1, ..., Re of the last.
  void unpack(const float* packed, std::size_t row) {
    Complex* out = rows_.get() + row * columns_;
    out[0] = packed[0];
    for (std::size_t c = 1; c + 1 < columns_; ++c) out[c] = {packed[2 * c - 1], packed[2 * c]};
    out[columns_ - 1] = packed[2 * columns_ - 3];
  }
  void pack(std::size_t row, float* packed) const {
    const Complex* in = rows_.get() + row * columns_;
    const auto value = [&](std::size_t c) { return is_used_[c] != 0 ? in[c] : Complex(); };
    packed[0] = value(0).real();
    for (std::size_t c = 1; c + 1 < columns_; ++c) {
      const Complex z = value(c);
      packed[2 * c - 1] = z.real();
      packed[2 * c] = z.imag();
    }
    packed[2 * columns_ - 3] = value(columns_ - 1).real();
  }

  /// Columns out of the rows' spectra, one after the other, continued beyond the last row.
  void gather(std::size_t first, std::size_t count, Complex* strip) const {
    for (std::size_t y = 0; y < height(); ++y) {
      const Complex* in = rows_.get() + y * columns_ + first;
      for (std::size_t c = 0; c < count; ++c) strip[c * length_ + y] = in[c];
    }
    for (std::size_t c = 0; c < count; ++c) {
      continue_line(filter_.beyond_columns_, strip + c * length_, height());
    }
  }

  /// Columns of the spectrum, the named ones in a strip, back to the rows' spectra.
  void restore(std::vector<Complex>& strip, const std::vector<std::size_t>& used) {
    if (used.empty()) return;
    cv::Mat view = column_view(strip.data(), used.size());
    cv::dft(view, view, cv::DFT_ROWS | cv::DFT_INVERSE | cv::DFT_SCALE);
    for (std::size_t y = 0; y < height(); ++y) {
      Complex* out = rows_.get() + y * columns_;
      for (std::size_t u = 0; u < used.size(); ++u) out[used[u]] = strip[u * length_ + y];
    }
    for (const std::size_t c : used) is_used_[c] = 1;
  }

  const FourierFilter& filter_;
  std::size_t columns_;
  std::size_t length_;
  std::unique_ptr<Complex[]> rows_;  ///< one after the other, without what continues them
  std::vector<char> is_used_;        ///< columns that are not 0
};

FrequencyResponse FourierFilter::tabulated(const FrequencyResponse& response) const {
  const auto table = std::make_shared<std::vector<float>>(column_count() * column_length());
  const auto width = static_cast<float>(padded_width_px_);
  base::parallel_for(column_count(), kPiece, [&](std::size_t c, std::size_t end) {
    for (; c < end; ++c) {
      const std::span<float> gains(table->data() + c * column_length(), column_length());
      const float fx = static_cast<float>(c) / width;
      if (!response(fx, fy_, gains)) std::fill(gains.begin(), gains.end(), 0.0F);
    }
  });
  return [table, width](float fx, std::span<const float> fy, std::span<float> gains) {
    const auto column = static_cast<std::size_t>(std::lround(fx * width));
    std::copy_n(table->data() + column * fy.size(), fy.size(), gains.data());
    return true;
  };
}

FourierFilter::Spectrum FourierFilter::spectrum_of(const Image& image,
                                                   const FrequencyResponse& response) const {
  assert(image.channel_count() == 1);
  assert(image.width_px == width_px_ && image.height_px == height_px_);
  Work work(*this);
  work.transform_rows(image);
  Spectrum spectrum(column_count() * column_length());
  work.transform_columns(response, spectrum);
  return spectrum;
}

void FourierFilter::filter(const Spectrum& spectrum, const FrequencyResponse& response,
                           Image& out) const {
  assert(spectrum.size() == column_count() * column_length());
  assert(out.width_px == width_px_ && out.height_px == height_px_ && out.channel_count() == 1);
  Work work(*this);
  work.restore_columns(spectrum, response);
  work.restore_rows(out);
}

void FourierFilter::filter(Image& image, const FrequencyResponse& response) const {
  assert(image.width_px == width_px_ && image.height_px == height_px_);
  Work work(*this);
  work.transform_rows(image);
  work.filter_columns(response);
  work.restore_rows(image);
}

}  // namespace perception

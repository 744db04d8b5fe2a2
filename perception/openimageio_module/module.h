#pragma once

// The C interface of the module discern_openimageio, a shared library opened on first need.
// Nothing here throws; memory from the module is freed by the module.

#include <cstddef>

extern "C" {

/// A decoded image; integers of n bits are divided by 2^n - 1, floats are as stored.
struct DiscernDecodedImage {
  int width_px;
  int height_px;
  int channel_count;
  int is_integer;       ///< 1 if the file holds integers, which are display-encoded by custom
  float* pixels;        ///< row-major, top-left first, channels interleaved
  char* channel_names;  ///< separated by '\n'
};

/// 8-bit pixels to encode, row-major, top-left first, channels interleaved.
struct DiscernByteImage {
  int width_px;
  int height_px;
  int channel_count;  ///< 1 Y, 3 RGB, 4 RGBA with unassociated alpha
  const unsigned char* pixels;
  int jpeg_quality;  ///< 1 ... 100: a JPEG without subsampling of colours; 0: a PNG
};

struct DiscernBytes {
  unsigned char* data;
  std::size_t size;
};

/// Where a failing call leaves its reason, zero-terminated.
struct DiscernReason {
  char text[1024];
};

/// Each returns 1, or 0 with the reason.
using DiscernDecode = int (*)(const char* path, DiscernDecodedImage*, DiscernReason*);
using DiscernEncode = int (*)(const DiscernByteImage*, DiscernBytes*, DiscernReason*);
using DiscernFree = void (*)(void* memory);

/// Exported names.
int discern_decode_image(const char* path, DiscernDecodedImage* image, DiscernReason* reason);
int discern_encode_image(const DiscernByteImage* source, DiscernBytes* bytes,
                         DiscernReason* reason);
void discern_free(void* memory);

}  // extern "C"

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace renderers::area_shadows {

/// No pixel, no fragment.
inline constexpr std::int32_t kNone = -1;

/// A square block of pixels that is lit as one.
struct Fragment {
  enum class State : std::uint8_t { open, split, final };

  std::int32_t x = 0;  ///< column and row among the blocks of its level
  std::int32_t y = 0;
  std::int8_t level = 0;   ///< 2^level pixels wide
  std::int8_t pieces = 0;  ///< a visibility test cut it into so many; 0: it did not
  State state = State::open;
  bool is_culled = false;         ///< no light can shine on any of its pixels
  bool crosses_surfaces = false;  ///< and is one nevertheless, as its pixels see lights alike
  /// Pixels whose surfaces stand for its quadrants: top left, top right, bottom right, bottom left;
  /// kNone for a quadrant outside the image or
  /// without a surface there. A fragment of one point has it first.
  std::array<std::int32_t, 4> pixels{kNone, kNone, kNone, kNone};

  int side_px() const { return 1 << level; }
  glm::ivec2 corner() const { return {x << level, y << level}; }
};

/// Fragments that make up a picture, and what it took to find them.
struct FragmentSet {
  int width_px = 0;
  int height_px = 0;
  std::vector<Fragment> fragments;  ///< final ones and those they came from
  std::vector<std::int32_t> at;     ///< per pixel the final fragment that holds it, or kNone
  std::uint64_t tested = 0;         ///< fragments that rays were cast for, pixels left out
  std::uint64_t rounds = 0;         ///< work lists that were worked off
  std::uint64_t rays = 0;
  std::uint64_t test_rays = 0;  ///< of these, those for fragments in `tested`
  std::uint64_t reopened = 0;   ///< fragments split because a finer one beside them differed

  std::size_t pixel(int x_px, int y_px) const {
    return static_cast<std::size_t>(y_px) * static_cast<std::size_t>(width_px) +
           static_cast<std::size_t>(x_px);
  }
  bool holds(const glm::ivec2& at_px) const {
    return at_px.x >= 0 && at_px.y >= 0 && at_px.x < width_px && at_px.y < height_px;
  }
};

/// Pixels of a fragment that lie in the image: [least, end).
struct PixelBox {
  glm::ivec2 least{0};
  glm::ivec2 end{0};
};
PixelBox pixels_of(const Fragment& fragment, const FragmentSet& set);

/// The fragment's four parts of the next finer level that begin inside the image, in the order of
/// its quadrants; the others are left out.
struct Parts {
  std::array<Fragment, 4> fragments{};
  std::array<int, 4> quadrants{};
  std::size_t count = 0;
};
Parts parts_of(const Fragment& fragment, const FragmentSet& set);

/// The quadrant that a pixel of the fragment lies in.
int quadrant_of(const Fragment& fragment, const glm::ivec2& pixel_px);

/// The pixels for `Fragment::pixels`: next to the quadrants' centres, those towards the fragment's
/// centre, so that their mean is that centre; moved into the image where it ends before.
std::array<std::int32_t, 4> quadrant_pixels(const Fragment& fragment, const FragmentSet& set);

/// The first of the fragment's `pixels` that there is.
std::int32_t first_pixel(const Fragment& fragment);

/// Mean position of the fragment's `pixels`, in pixels from the image's top left corner.
glm::vec2 centre_of(const Fragment& fragment, const FragmentSet& set);

/// Writes the fragment's index, or kNone, into all of its pixels.
void label(const Fragment& fragment, std::int32_t index, FragmentSet& set);

}  // namespace renderers::area_shadows

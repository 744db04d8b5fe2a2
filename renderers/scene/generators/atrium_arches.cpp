#include "renderers/scene/generators/atrium_pieces.h"

#include <array>
#include <cmath>
#include <numbers>

namespace renderers::scene {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// Point of the opening's curve, from +half_span (i = 0) to -half_span.
glm::vec2 on_arch(const ArchShape& shape, int i) {
  const float angle = kPi * static_cast<float>(i) / static_cast<float>(shape.segments);
  const float x = i == shape.segments ? -shape.half_span_m : shape.half_span_m * std::cos(angle);
  const float y = i == shape.segments ? 0.0F : shape.rise_m * std::sin(angle);
  return {x, shape.springing_m + y};
}

/// One stone between two radii and two angles (counter-clockwise from +x), through the wall.
struct Stone {
  float inner_m;
  float outer_m;
  float first_rad;
  float last_rad;
  float least_z_m;
  float greatest_z_m;
};

glm::vec3 on_stone(const Stone& stone, float radius_m, float t, float z_m, float springing_m) {
  const float angle = stone.first_rad + (stone.last_rad - stone.first_rad) * t;
  return {radius_m * std::cos(angle), springing_m + radius_m * std::sin(angle), z_m};
}

void add_stone(TriangleSoup& soup, const Stone& stone, float springing_m, int segments) {
  const auto at = [&](bool outer, int i, bool back) {
    const float t = static_cast<float>(i) / static_cast<float>(segments);
    return on_stone(stone, outer ? stone.outer_m : stone.inner_m, t,
                    back ? stone.greatest_z_m : stone.least_z_m, springing_m);
  };
  for (int i = 0; i < segments; ++i) {
    const int next = i + 1;
    soup.add_polygon(
        {at(false, i, false), at(false, next, false), at(true, next, false), at(true, i, false)});
    soup.add_polygon(
        {at(false, i, true), at(true, i, true), at(true, next, true), at(false, next, true)});
    soup.add_polygon(
        {at(false, i, false), at(false, i, true), at(false, next, true), at(false, next, false)});
    soup.add_polygon(
        {at(true, i, false), at(true, next, false), at(true, next, true), at(true, i, true)});
  }
  soup.add_polygon(
      {at(false, 0, false), at(true, 0, false), at(true, 0, true), at(false, 0, true)});
  soup.add_polygon({at(false, segments, false), at(false, segments, true), at(true, segments, true),
                    at(true, segments, false)});
}

}  // namespace

TriangleSoup arch_panel(const ArchShape& shape) {
  TriangleSoup soup;
  const float front = shape.least_z_m;
  const float back = shape.greatest_z_m;
  const auto add_strip = [&](const glm::vec2& right, const glm::vec2& left) {
    soup.add_polygon({{right.x, right.y, front},
                      {left.x, left.y, front},
                      {left.x, shape.top_m, front},
                      {right.x, shape.top_m, front}});
    soup.add_polygon({{left.x, left.y, back},
                      {right.x, right.y, back},
                      {right.x, shape.top_m, back},
                      {left.x, shape.top_m, back}});
  };
  for (int i = 0; i < shape.segments; ++i) {
    const glm::vec2 right = on_arch(shape, i);
    const glm::vec2 left = on_arch(shape, i + 1);
    add_strip(right, left);
    soup.add_polygon({{right.x, right.y, front},
                      {right.x, right.y, back},
                      {left.x, left.y, back},
                      {left.x, left.y, front}});
  }
  if (shape.half_width_m > shape.half_span_m) {
    add_strip({shape.half_width_m, shape.springing_m}, on_arch(shape, 0));
    add_strip(on_arch(shape, shape.segments), {-shape.half_width_m, shape.springing_m});
  }
  return soup;
}

TriangleSoup voussoirs(const ArchShape& shape, int stones, int segments) {
  constexpr float kInner_m = 0.025F;   // into the opening
  constexpr float kOuter_m = 0.26F;    // of the stones, from the opening outwards
  constexpr float kProud_m = 0.035F;   // before the wall's face
  constexpr float kProuder_m = 0.06F;  // every second stone
  constexpr float kJoint = 0.06F;      // of a stone's angle
  TriangleSoup soup;
  const float step_rad = kPi / static_cast<float>(stones);
  for (int i = 0; i < stones; ++i) {
    const bool is_proud = i % 2 == (stones / 2) % 2;
    const bool is_key = i == stones / 2;
    const float proud_m = is_proud ? kProuder_m : kProud_m;
    const float first = step_rad * static_cast<float>(i);
    const Stone stone{shape.half_span_m - kInner_m - (is_proud ? 0.01F : 0.0F),
                      shape.half_span_m + kOuter_m + (is_key ? 0.08F : 0.0F),
                      first + 0.5F * kJoint * step_rad,
                      first + (1.0F - 0.5F * kJoint) * step_rad,
                      shape.least_z_m - proud_m,
                      shape.greatest_z_m + proud_m};
    add_stone(soup, stone, shape.springing_m, segments);
  }
  return soup;
}

TriangleSoup groin_vault(const glm::vec2& half_size_m, float springing_m, float rise_m,
                         int segments) {
  TriangleSoup soup;
  // The four webs: each reaches from the crown to one edge and ends at the diagonals.
  for (int web = 0; web < 4; ++web) {
    const auto point = [&](int i, int j) {
      const float along = 0.5F * kPi * static_cast<float>(j) / static_cast<float>(segments);
      // The quotient is exactly 1 at the diagonals, where two webs meet.
      const float across =
          along * (static_cast<float>(i - segments) / static_cast<float>(segments));
      const float u = std::sin(across);
      const float v = std::sin(along);
      // Counter-clockwise seen from below: turns of a right angle about the vertical.
      const std::array<glm::vec2, 4> places{glm::vec2(u, v), glm::vec2(v, -u), glm::vec2(-u, -v),
                                            glm::vec2(-v, u)};
      const glm::vec2 place = places[static_cast<std::size_t>(web)] * half_size_m;
      const glm::vec3 position(place.x, springing_m + rise_m * std::cos(across), place.y);
      return Corner{position, place / kTexturePeriod_m};
    };
    soup.add_grid(2 * segments, segments, point);
  }
  return soup;
}

}  // namespace renderers::scene

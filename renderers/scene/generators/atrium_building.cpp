#include "renderers/scene/generators/atrium_building.h"

#include "renderers/scene/generators/atrium_pieces.h"
#include "renderers/scene/generators/atrium_plan.h"
#include "renderers/scene/generators/uniform_number.h"

#include <array>
#include <cmath>
#include <random>
#include <utility>

namespace renderers::scene {
namespace {

// Half sizes of the skylight, along x and z, metres.
constexpr float kSkylightX_m = 2.0F;
constexpr float kSkylightZ_m = 7.0F;

class Building {
 public:
  Building(std::uint64_t seed, const AtriumDetail& detail) : engine_(seed), detail_(detail) {}

  AtriumParts build() {
    for (int turn = 0; turn < 4; ++turn) {
      const bool is_long = turn % 2 == 1;
      const float half_m = is_long ? kHalfLength_m : kHalfWidth_m;
      const float distance_m = is_long ? kHalfWidth_m : kHalfLength_m;
      const int bays = static_cast<int>(std::lround(2.0F * half_m / kBay_m));
      add_side(parts_, {quarter_turns(turn), half_m, distance_m, bays}, detail_, engine_);
    }
    add_shell();
    add_corners();
    add_roof_beams();
    add_furniture();
    return std::move(parts_);
  }

 private:
  /// Floor, outer walls, gallery, roof with its opening, skylight, the outside of it all.
  void add_shell() {
    const float x = kHalfWidth_m + kOuter_m;
    const float z = kHalfLength_m + kOuter_m;
    parts_["floor"].add_polygon({{-x, 0, -z}, {-x, 0, z}, {x, 0, z}, {x, 0, -z}});
    const std::array<glm::vec2, 4> outer{glm::vec2(-x, -z), {x, -z}, {x, z}, {-x, z}};
    const float inner_x = kHalfWidth_m - kHalfWall_m;
    const float inner_z = kHalfLength_m - kHalfWall_m;
    const std::array<glm::vec2, 4> court{glm::vec2(-inner_x, -inner_z),
                                         {inner_x, -inner_z},
                                         {inner_x, inner_z},
                                         {-inner_x, inner_z}};
    const std::array<glm::vec2, 4> hole{glm::vec2(-kSkylightX_m, -kSkylightZ_m),
                                        {kSkylightX_m, -kSkylightZ_m},
                                        {kSkylightX_m, kSkylightZ_m},
                                        {-kSkylightX_m, kSkylightZ_m}};
    const auto at = [](const glm::vec2& p, float y) { return glm::vec3(p.x, y, p.y); };
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t k = (i + 1) % 4;
      parts_["walls"].add_polygon(
          {at(outer[i], 0), at(outer[k], 0), at(outer[k], kRoof_m), at(outer[i], kRoof_m)});
      parts_["gallery"].add_polygon({at(outer[k], kGallery_m), at(outer[i], kGallery_m),
                                     at(court[i], kGallery_m), at(court[k], kGallery_m)});
      parts_["roof"].add_polygon({at(outer[i], kRoof_m), at(outer[k], kRoof_m),
                                  at(hole[k], kRoof_m), at(hole[i], kRoof_m)});
    }
    constexpr float kThickness_m = 0.4F;  // of walls, roof and foundation
    parts_["shell"].add_box({-x - kThickness_m, -kThickness_m, -z - kThickness_m},
                            {x + kThickness_m, kRoof_m + kThickness_m, z + kThickness_m});
    parts_["skylight"].add_polygon(
        {at(hole[0], kRoof_m), at(hole[1], kRoof_m), at(hole[2], kRoof_m), at(hole[3], kRoof_m)});
  }

  /// Piers and the vaults behind them.
  void add_corners() {
    for (const float side_x : {-1.0F, 1.0F}) {
      for (const float side_z : {-1.0F, 1.0F}) {
        const glm::vec3 axis(side_x * kHalfWidth_m, 0.0F, side_z * kHalfLength_m);
        const auto block = [&](float half_m, float bottom_m, float top_m, unsigned open) {
          parts_["arcade"].add_box(axis + glm::vec3(-half_m, bottom_m, -half_m),
                                   axis + glm::vec3(half_m, top_m, half_m), open);
        };
        block(kPier_m, 0.0F, kRoof_m, kLeastY | kGreatestY);
        block(kPier_m + 0.08F, 0.0F, 0.4F, kLeastY);
        block(kPier_m + 0.06F, kSpringing_m - 0.16F, kSpringing_m, kNoSide);
        block(kPier_m + 0.06F, kGallery_m + kUpperColumn_m - 0.16F, kGallery_m + kUpperColumn_m,
              kNoSide);
        const glm::vec3 center = axis + 0.5F * kOuter_m * glm::vec3(side_x, 0.0F, side_z);
        parts_["vaults"].append(
            groin_vault(glm::vec2(0.5F * kOuter_m), kSpringing_m, 1.8F, scaled(detail_, 6, 2)),
            moved(center.x, 0.0F, center.z));
      }
    }
  }

  void add_roof_beams() {
    for (int i = 1; i < 6; ++i) {
      const float z = -kHalfLength_m + kBay_m * static_cast<float>(i);
      parts_["wood"].add_box({-kHalfWidth_m, kRoof_m - 0.75F, z - 0.13F},
                             {kHalfWidth_m, kRoof_m - 0.4F, z + 0.13F});
    }
  }

  /// A basin in the middle of the court, vases with plants on pedestals along its sides.
  void add_furniture() {
    const Profile basin{{1.35F, 0.0F},  {1.35F, 0.12F}, {1.20F, 0.16F}, {1.14F, 0.45F},
                        {1.28F, 0.55F}, {1.28F, 0.62F}, {1.06F, 0.62F}, {1.02F, 0.30F},
                        {0.30F, 0.26F}, {0.16F, 0.40F}, {0.14F, 0.95F}, {0.22F, 1.05F},
                        {0.62F, 1.22F}, {0.66F, 1.28F}, {0.58F, 1.28F}, {0.10F, 1.14F},
                        {0.07F, 1.45F}, {0.12F, 1.55F}, {0.0F, 1.68F}};
    TriangleSoup fountain;
    Profile curve = smoothed(basin, detail_.level > 0.6F ? 1 : 0);
    for (glm::vec2& p : curve) p.x = std::max(p.x, 0.0F);
    add_lathe(fountain, curve, scaled(detail_, 40, 12));
    parts_["vases"].append(fountain, moved(0.0F, 0.0F, 1.8F));
    const TriangleSoup pot = vase(0.9F, scaled(detail_, 24, 8), detail_.level > 0.6F ? 2 : 0);
    for (const float x : {-2.35F, 2.35F}) {
      for (const float z : {-7.2F, -3.6F, 0.0F, 3.6F, 7.2F}) {
        const float off_z = uniform(engine_, -0.2F, 0.2F);
        const float off_x = uniform(engine_, -0.06F, 0.06F);
        const glm::vec3 foot(x + off_x, 0.0F, z + off_z);
        parts_["vases"].add_box(foot + glm::vec3(-0.3F, 0.0F, -0.3F),
                                foot + glm::vec3(0.3F, 0.35F, 0.3F), kLeastY);
        parts_["vases"].append(pot, moved(foot.x, 0.35F, foot.z));
        parts_["plants"].append(plant(engine_, 36, scaled(detail_, 5, 3)),
                                moved(foot.x, 0.85F, foot.z));
      }
    }
  }

  std::mt19937_64 engine_;
  AtriumDetail detail_;
  AtriumParts parts_;
};

}  // namespace

AtriumParts atrium_building(std::uint64_t seed, const AtriumDetail& detail) {
  return Building(seed, detail).build();
}

}  // namespace renderers::scene

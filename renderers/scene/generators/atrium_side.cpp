#include "renderers/scene/generators/atrium_pieces.h"
#include "renderers/scene/generators/atrium_plan.h"
#include "renderers/scene/generators/uniform_number.h"

namespace renderers::scene {
namespace {

class SideBuilder {
 public:
  SideBuilder(AtriumParts& parts, const Side& side, const AtriumDetail& detail,
              std::mt19937_64& engine)
      : parts_(parts), side_(side), detail_(detail), engine_(engine) {}

  void build() {
    const ColumnShape lower = column_shape(kSpringing_m, 0.28F);
    const ColumnShape upper = column_shape(kUpperColumn_m, 0.22F);
    const TriangleSoup lower_column = column(lower);
    const TriangleSoup upper_column = column(upper);
    for (int i = 1; i < side_.bays; ++i) {
      const float x = -side_.half_length_m + kBay_m * static_cast<float>(i);
      add("columns", lower_column, {x, 0.0F, side_.distance_m});
      add("columns", upper_column, {x, kGallery_m, side_.distance_m});
    }
    for (int i = 0; i < side_.bays; ++i) {
      add_bay(-side_.half_length_m + kBay_m * (static_cast<float>(i) + 0.5F), i);
    }
    for (int i = 0; i <= side_.bays; ++i) {
      add_column_line(-side_.half_length_m + kBay_m * static_cast<float>(i));
    }
    add_cornices();
  }

 private:
  void add(const char* part, const TriangleSoup& soup, const glm::vec3& at) {
    parts_[part].append(soup, side_.to_world * moved(at.x, at.y, at.z));
  }

  ColumnShape column_shape(float height_m, float radius_m) const {
    ColumnShape shape;
    shape.height_m = height_m;
    shape.radius_m = radius_m;
    shape.flutes = scaled(detail_, 16, 6);
    shape.around_flute = detail_.level > 1.6F ? 5 : 3;
    shape.rings = scaled(detail_, 4, 2);
    shape.around = scaled(detail_, 20, 8);
    shape.smoothing = detail_.level > 1.8F ? 2 : (detail_.level > 0.6F ? 1 : 0);
    return shape;
  }

  ArchShape lower_arch() const {
    ArchShape shape;
    shape.half_width_m = 0.5F * kBay_m;
    shape.half_span_m = kHalfSpan_m;
    shape.rise_m = kHalfSpan_m;
    shape.springing_m = kSpringing_m;
    shape.top_m = kGallery_m;
    shape.least_z_m = -kHalfWall_m;
    shape.greatest_z_m = kHalfWall_m;
    shape.segments = 2 * scaled(detail_, 10, 4);
    return shape;
  }

  ArchShape upper_arch() const {
    ArchShape shape = lower_arch();
    shape.springing_m = kGallery_m + kUpperColumn_m;
    shape.top_m = kRoof_m;
    return shape;
  }

  void add_bay(float x, int index) {
    const glm::vec3 at(x, 0.0F, side_.distance_m);
    // Panels next to a corner pier end inside it.
    for (const ArchShape& arch : {lower_arch(), upper_arch()}) {
      add("arcade", arch_panel(arch), at);
      add("voussoirs", voussoirs(arch, 15, scaled(detail_, 2, 1)), at);
    }
    const float center_z = side_.distance_m + kHalfWall_m + 0.5F * kAisle_m;
    add("vaults",
        groin_vault({0.5F * kBay_m, 0.5F * kAisle_m}, kSpringing_m, 1.8F, scaled(detail_, 6, 2)),
        {x, 0.0F, center_z});
    add_balustrade(x);
    add_cloths(x, index);
  }

  void add_balustrade(float x) {
    constexpr int kBalusters = 8;
    constexpr float kLength_m = 3.06F;  // ends inside the shafts
    const float foot = kGallery_m + 0.14F;
    TriangleSoup rails;
    rails.add_box({-0.5F * kLength_m, kGallery_m + 0.04F, -0.11F}, {0.5F * kLength_m, foot, 0.11F});
    rails.add_box({-0.5F * kLength_m, foot + 0.66F, -0.13F},
                  {0.5F * kLength_m, foot + 0.78F, 0.13F});
    add("balustrade", rails, {x, 0.0F, side_.distance_m});
    const Profile outline{{0.060F, -0.01F}, {0.060F, 0.05F}, {0.035F, 0.08F}, {0.050F, 0.14F},
                          {0.075F, 0.24F},  {0.055F, 0.36F}, {0.030F, 0.48F}, {0.032F, 0.54F},
                          {0.055F, 0.60F},  {0.055F, 0.67F}};
    TriangleSoup baluster;
    add_lathe(baluster, smoothed(outline, detail_.level > 1.5F ? 1 : 0), scaled(detail_, 9, 5));
    for (int i = 0; i < kBalusters; ++i) {
      const float along = (static_cast<float>(i) + 0.5F) / static_cast<float>(kBalusters) - 0.5F;
      add("balustrade", baluster, {x + 2.6F * along, foot, side_.distance_m});
    }
  }

  /// Transverse arch of the vault, pilaster, beam over the gallery.
  void add_column_line(float x) {
    const float aisle_z = side_.distance_m + kHalfWall_m;
    ArchShape rib;
    rib.half_width_m = 0.5F * kAisle_m;
    rib.half_span_m = 0.5F * kAisle_m;
    rib.rise_m = 1.7F;
    rib.springing_m = kSpringing_m;
    rib.top_m = kGallery_m - 0.05F;
    rib.least_z_m = -0.2F;
    rib.greatest_z_m = 0.2F;
    rib.segments = 2 * scaled(detail_, 7, 3);
    parts_["arcade"].append(
        arch_panel(rib),
        side_.to_world * moved(x, 0.0F, aisle_z + 0.5F * kAisle_m) * quarter_turns(1));
    TriangleSoup pilaster;
    const float wall_z = side_.distance_m + kOuter_m;
    pilaster.add_box({x - 0.32F, 0.0F, wall_z - 0.2F}, {x + 0.32F, 0.5F, wall_z},
                     kLeastY | kGreatestZ);
    pilaster.add_box({x - 0.26F, 0.5F, wall_z - 0.14F}, {x + 0.26F, 2.95F, wall_z},
                     kLeastY | kGreatestY | kGreatestZ);
    pilaster.add_box({x - 0.34F, 2.95F, wall_z - 0.24F}, {x + 0.34F, kSpringing_m, wall_z},
                     kGreatestZ);
    pilaster.add_box({x - 0.24F, kGallery_m, wall_z - 0.14F}, {x + 0.24F, kRoof_m - 0.4F, wall_z},
                     kLeastY | kGreatestY | kGreatestZ);
    add("walls", pilaster, glm::vec3(0.0F));
    TriangleSoup beam;
    // Two joists to each side of the beam, up to the middles of the bays.
    for (const float shift_m : {-1.5F, -0.9F, 0.9F, 1.5F}) {
      if (std::abs(x + shift_m) > side_.half_length_m) continue;
      beam.add_box({x + shift_m - 0.05F, kRoof_m - 0.2F, side_.distance_m},
                   {x + shift_m + 0.05F, kRoof_m, wall_z}, kGreatestY | kGreatestZ);
    }
    beam.add_box({x - 0.14F, kRoof_m - 0.4F, side_.distance_m}, {x + 0.14F, kRoof_m, wall_z},
                 kGreatestY | kGreatestZ);
    add("wood", beam, glm::vec3(0.0F));
  }

  /// Mouldings that run around the court, with dentils below them.
  void add_cornices() {
    // (how far before the wall, height above the foot), from bottom to top.
    const Profile moulding{{0.0F, 0.0F},   {0.06F, 0.02F}, {0.08F, 0.10F}, {0.15F, 0.12F},
                           {0.18F, 0.20F}, {0.26F, 0.26F}, {0.30F, 0.30F}, {0.30F, 0.38F}};
    for (const float top_m : {kGallery_m, kRoof_m - 0.35F}) {
      const float foot_m = top_m - 0.38F;
      const auto point = [&](int i, int j) {
        // The lid goes back to the wall.
        const bool is_lid = j == static_cast<int>(moulding.size());
        const glm::vec2 p = is_lid ? glm::vec2(0.0F, 0.38F) : moulding[static_cast<std::size_t>(j)];
        const float half_m = side_.half_length_m - kHalfWall_m - p.x;
        const float x = i == 0 ? half_m : -half_m;
        const float z = side_.distance_m - kHalfWall_m - p.x;
        return Corner{{x, foot_m + p.y, z}, glm::vec2(x, foot_m + p.y - z) / kTexturePeriod_m};
      };
      TriangleSoup run;
      run.add_grid(1, static_cast<int>(moulding.size()), point);
      add("arcade", run, glm::vec3(0.0F));
      add_dentils(foot_m);
    }
  }

  void add_dentils(float top_m) {
    constexpr float kSpacing_m = 0.3F;
    const float wall_z = side_.distance_m - kHalfWall_m;
    const auto count = static_cast<int>((2.0F * side_.half_length_m - 1.2F) / kSpacing_m);
    TriangleSoup dentils;
    for (int i = 0; i < count; ++i) {
      const float x = kSpacing_m * (static_cast<float>(i) - 0.5F * static_cast<float>(count - 1));
      dentils.add_box({x - 0.06F, top_m - 0.12F, wall_z - 0.07F},
                      {x + 0.06F, top_m + 0.03F, wall_z}, kGreatestY | kGreatestZ);
    }
    add("arcade", dentils, glm::vec3(0.0F));
  }

  /// Curtains in lower arches, banners over the gallery's rail.
  void add_cloths(float x, int index) {
    const bool is_long = side_.bays > 2;
    ClothShape shape;
    shape.rows = detail_.cloth_rows;
    shape.columns = std::max(6, (3 * detail_.cloth_rows) / 4);
    shape.phase = uniform(engine_, 0.0F, 1.0F);
    const float length_m = uniform(engine_, 0.0F, 1.0F);
    if (is_long && index % 2 == 0) {
      shape.width_m = 2.5F;
      shape.top_m = kSpringing_m + 0.45F;
      shape.bottom_m = 1.0F + 0.5F * length_m;
      shape.fold_depth_m = 0.14F;
      shape.folds = uniform(engine_, 4.0F, 6.0F);
      add(index % 4 == 0 ? "curtain-a" : "curtain-b", hanging_cloth(shape),
          {x, 0.0F, side_.distance_m});
      TriangleSoup rod;
      rod.add_box({-1.4F, kSpringing_m + 0.43F, -0.02F}, {1.4F, kSpringing_m + 0.48F, 0.02F});
      add("wood", rod, {x, 0.0F, side_.distance_m + 0.1F});
    } else if (is_long || index == 1) {
      shape.width_m = 1.3F;
      shape.top_m = kGallery_m + 1.0F;
      shape.bottom_m = kGallery_m - 1.2F - 0.7F * length_m;
      shape.fold_depth_m = 0.07F;
      shape.folds = uniform(engine_, 2.5F, 3.5F);
      add("banners", hanging_cloth(shape), {x, 0.0F, side_.distance_m - kHalfWall_m - 0.45F});
    }
  }

  AtriumParts& parts_;
  const Side& side_;
  const AtriumDetail& detail_;
  std::mt19937_64& engine_;
};

}  // namespace

void add_side(AtriumParts& parts, const Side& side, const AtriumDetail& detail,
              std::mt19937_64& engine) {
  SideBuilder(parts, side, detail, engine).build();
}

}  // namespace renderers::scene

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/ray_bundles/bundle_frame.h"
#include "renderers/ray_bundles/bundle_lists.h"
#include "renderers/ray_bundles/directed_emission.h"
#include "renderers/ray_bundles/light_solution.h"
#include "renderers/ray_bundles/texture_detail.h"
#include "renderers/texel_atlas/texel_atlas.h"

/// Radiance between the neighbours on every line of a bundle.
///
/// Source: Hermes, Henrich, Grosch, Mueller 2010, "Global Illumination using Parallel Global
/// Ray-Bundles", VMV, doi:10.2312/PE/VMV/VMV10/065-072, Eq. 3, whose factor 2 pi / N the text of
/// the paper leaves out (`LightSolution` has it).
namespace renderers::ray_bundles {

/// What enters through the ends of the lines: radiance of the environment.
struct EndLight {
  glm::vec3 ahead{0.0F};   ///< arriving along -w, at the far end
  glm::vec3 behind{0.0F};  ///< arriving along +w, at the near end
};

/// Senders that are no surface.
constexpr std::uint32_t kAhead = 0xffffffffU;
constexpr std::uint32_t kBehind = 0xfffffffeU;
constexpr bool is_end(std::uint32_t sender) { return sender >= kBehind; }

/// A side that looks at a receiver, or an end of the line.
struct Sender {
  std::uint32_t side = kBehind;
  float depth_m = 0.0F;  ///< of the crossing
};

/// Senders on both sides of a surface.
struct Partners {
  Sender before{kBehind};  ///< on the line
  Sender after{kAhead};
  glm::ivec2 line_px{0};  ///< whose line
};

/// Lines of one direction and what they cross.
struct Bundle {
  const BundleFrame& frame;
  const BundleLists& lists;
  EndLight ends;
  const TextureDetail* detail = nullptr;       ///< null: senders have their texels' means
  const DirectedEmission* directed = nullptr;  ///< null: no emission depends on the direction
  float weight = 1.0F;                         ///< `BundleDirection::weight`
};

/// Radiance that a sender, no end of the line, has along the bundle at hand.
struct SentLight {
  glm::vec3 emitted{0.0F};  ///< 0 if bundles carry no emission
  glm::vec3 reflected{0.0F};
  glm::vec3 reflected_diffuse{0.0F};  ///< its part that Lambert lobes reflect
};
/// @param line_px  whose line crosses the sender
SentLight light_of(const Sender& sender, const glm::ivec2& line_px, const Bundle& bundle,
                   const LightSolution& solution);

struct ExchangeCounts {
  std::uint64_t receivers = 0;  ///< sides that got a sample
  std::uint64_t pairs = 0;      ///< sides that got their sample from another surface
  std::uint64_t lit_pairs = 0;  ///< of them, those whose sender was not black
  std::uint64_t unmatched = 0;  ///< texels that no line beside them meets (gather)

  void add(const ExchangeCounts& other) {
    receivers += other.receivers;
    pairs += other.pairs;
    lit_pairs += other.lit_pairs;
    unmatched += other.unmatched;
  }
};

/// What the exchange needs of a texel, close together in memory.
struct ExchangeTexel {
  glm::vec3 position{0.0F};
  float area_m2 = 0.0F;
  glm::vec3 geometric_normal{0.0F};
  glm::vec3 shading_normal{0.0F};
};
std::vector<ExchangeTexel> exchange_texels(const texel_atlas::TexelAtlas& atlas);

/// A point's neighbours on the nearest of the four lines around it that meets its surface: beside
/// an edge, the nearest line of all may pass by ("self-localization", Sec. 4.2 and Fig. 5).
/// @param point  with its normals; no area needed  @param texel  that it lies in
/// @return nothing if no line meets it, or it lies nearly along the direction, |n . w| < 0.02
std::optional<Partners> find_partners(const ExchangeTexel& point, std::uint32_t texel,
                                      const Bundle& bundle);

/// The paper's second pass (Sec. 4.2 and Fig. 5): every texel finds itself in the list of a line
/// beside its point and takes the radiance of its neighbours there, weight |n . w|.
///
/// A texel that none of the four lines around it meets takes no part in this direction, nor does
/// one nearly along the direction, |n . w| < 0.02. Differs from the paper: each side of a texel
/// takes part, as surfaces reflect on both.
ExchangeCounts gather(std::span<const ExchangeTexel> texels, const Bundle& bundle,
                      LightSolution& solution);

/// Every pair of neighbours on a line exchanges radiance; a texel's sample is the mean over the
/// lines that meet it, its weight their area over the texel's: a_p n / A, in the mean over
/// directions |n . w| as well.
///
/// The sums of a texel are made in the order of the lines, whatever the number of threads.
class Scatter {
 public:
  /// @param texels  must live as long as this
  explicit Scatter(std::span<const ExchangeTexel> texels);
  ExchangeCounts exchange(const Bundle& bundle, LightSolution& solution);

 private:
  /// A receiving side and where its light comes from.
  struct Transfer {
    std::uint32_t receiver = 0;
    std::uint32_t sender = 0;
  };
  /// A sender that is not its texel's mean.
  struct DetailedSender {
    std::uint32_t side = 0;
    PointColors colors;
  };
  struct Band {
    std::vector<std::vector<Transfer>> buckets;  ///< by the receiver's texel
    std::vector<DetailedSender> detailed;
  };
  void sort_band(const Bundle& bundle, std::size_t band);
  static void add_special(const Transfer& transfer, const Band& band, const Bundle& bundle,
                          const LightSolution& solution, TexelSample& sample,
                          ExchangeCounts& counts);
  ExchangeCounts add_bucket(const Bundle& bundle, std::size_t bucket,
                            LightSolution& solution) const;

  std::span<const ExchangeTexel> texels_;
  std::size_t bucket_count_;
  std::vector<Band> bands_;
};

}  // namespace renderers::ray_bundles

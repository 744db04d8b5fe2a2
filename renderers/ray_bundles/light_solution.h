#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/texel_atlas/texel_atlas.h"

namespace renderers::ray_bundles {

class GlossyTransfer;

/// What senders reflect while the solution is still being made. x is the mean of a direction's
/// incident radiance at a texel, weight c (|n . w|, or what the lines' area makes of it).
enum class FeedKind {
  /// J += a (x - J), a = min(1, 2 c k / (i + k)): the start is forgotten like i^-k(1 - albedo);
  /// k >= 1 / (1 - greatest albedo). Aimed directions (`importance`) weigh up to 1 / (1 - share):
  /// the cut at 1 takes from those while i < k (2 c - 1), which is forgotten, too. Ours.
  growing_step,
  /// The mean of all directions so far (Hermes et al. 2010, Sec. 5.5, "interleaved light
  /// transfer"). The dark start stays in the mean: energy misses by
  /// Gamma(N + rho) / (Gamma(rho) Gamma(N + 1)).
  running_mean,
  /// One bounce after the other (ibid., Sec. 5.2), each with its share of the directions.
  jacobi,
  /// What the last direction brought, alone; the solution is the mean of these. Szirmay-Kalos 1999,
  /// "Stochastic Iteration for Non-diffuse Global Illumination", doi:10.1111/1467-8659.00344.
  /// Needs independent directions; its variance is finite for albedos below 0.866.
  stochastic
};

/// What sums over directions are divided by.
enum class Normalisation {
  self,    ///< the sum of the weights: exact in a constant field. Ours
  uniform  ///< N / 2, what the weights sum to in the limit: linear in the light, for energy tests
};

struct SolutionSettings {
  FeedKind feed = FeedKind::growing_step;
  double step_k = 8.0;  ///< growing_step only
  Normalisation normalisation = Normalisation::self;
  /// Directions at the beginning that carry emission alone.
  std::int64_t direct_only = 0;
  std::int64_t bounce_directions = 256;  ///< of each bounce, jacobi only
  bool restarts_output = true;   ///< growing_step: the output forgets what is older than N / 2
  bool has_back_sides = true;    ///< false: back sides are black and receive nothing
  bool carries_emission = true;  ///< to Lambert lobes; false: their direct light is known
  bool glossy_chain = false;     ///< lobes send light to other surfaces: `GlossyTransfer`
};

/// What a texel gets from one bundle: sums weighted by c, which its sides share.
struct TexelSample {
  struct SideLight {
    glm::vec3 emitted{0.0F};    ///< straight from its source
    glm::vec3 reflected{0.0F};  ///< from senders that reflect it
  };
  float weight = 0.0F;  ///< c; 0: the bundle missed the texel
  SideLight sides[2];   ///< by texel_atlas::Side
};

/// Light on the texels' sides, from bundle after bundle.
///
/// All light is kept as mean incident radiance J = E / pi, so that albedo J leaves the surface. J
/// of sources (`direct`) and J of senders (`indirect`) are apart; the first is unbiased at all
/// times.
///
/// Sources: Hermes et al. 2010, Sec. 5; the feeds and what is wrong with the paper's are derived in
/// `FeedKind`.
class LightSolution {
 public:
  LightSolution(const texel_atlas::TexelAtlas& atlas, const SolutionSettings& settings);

  /// Sums over a range of directions.
  struct Sums {
    std::vector<glm::vec3> light;  ///< per side
    std::vector<float> weight;     ///< per texel
    std::int64_t begin = 0;        ///< first direction
    void reset(std::size_t texels, std::int64_t first_direction);
  };
  /// What `receive` changes, but for feed jacobi and lobes; for a solution made by a device.
  struct Received {
    Sums direct;                  ///< of sources; without light if bundles carry none
    Sums window;                  ///< of senders, directions since the last power of two
    Sums older;                   ///< those between it and the power of two before
    std::vector<glm::vec3> feed;  ///< per side
  };
  const Received& received() const { return received_; }
  /// Instead of `receive`, after `end_direction`. @param sent  per side, by the next bundle's
  /// senders
  void set_received(Received received, std::vector<glm::vec3> sent);

  /// Direct light known beforehand, J per side, which bundles must not carry as well.
  void set_known_direct(std::vector<glm::vec3> incident);
  const std::vector<glm::vec3>& known_direct() const { return known_; }
  /// Where samples go as well and what senders reflect by their lobes. @param glossy  must live as
  /// long as this; with `glossy_chain` only
  void set_glossy(GlossyTransfer* glossy);

  /// Radiance of a texel's front from here on; only if `brings_emission()`.
  void set_emitted(std::uint32_t texel, const glm::vec3& radiance) {
    emitted_[2 * texel] = radiance;
  }
  /// What senders reflect in the next bundle, per side, instead of what was received.
  void set_sent(const std::vector<glm::vec3>& sent) { sent_ = sent; }
  /// Before the samples of the next bundle. @param weight  `BundleDirection::weight`
  void begin_direction(float weight = 1.0F);
  /// From any thread; each texel exactly once per direction.
  void receive(std::uint32_t texel, const TexelSample& sample);
  /// After the samples; what was received is what senders reflect from here on.
  void end_direction();

  /// Radiance that a side emits or reflects, as senders in the bundle at hand.
  glm::vec3 emitted(std::uint32_t side) const {
    return brings_emission() ? emitted_[side] : glm::vec3(0.0F);
  }
  const glm::vec3& reflected(std::uint32_t side) const {
    return glossy_ == nullptr ? sent_[side] : sent_by_all_[side];
  }
  /// Its part that Lambert lobes reflect.
  const glm::vec3& reflected_diffuse(std::uint32_t side) const { return sent_[side]; }

  /// True from the first direction on that carries reflected light.
  bool carries_reflected() const { return directions_ >= settings_.direct_only; }
  /// True if samples need the light of sources; lobes are never lit beforehand.
  bool brings_emission() const { return settings_.carries_emission || settings_.glossy_chain; }
  std::int64_t directions() const { return directions_; }
  const SolutionSettings& settings() const { return settings_; }
  /// J of sources: known beforehand + bundles.
  glm::vec3 direct(std::uint32_t side) const;
  /// J of sources that bundles carried.
  glm::vec3 direct_of_bundles(std::uint32_t side) const;
  /// J of light that was reflected at least once, as senders reflect it on.
  const glm::vec3& feed(std::uint32_t side) const { return received_.feed[side]; }
  /// J of light that was reflected at least once.
  glm::vec3 indirect(std::uint32_t side) const;
  std::int64_t memory_bytes() const;

 private:
  glm::vec3 mean(const glm::vec3& sum, float weight, double directions) const;
  void step_feed(std::uint32_t side, float weight, const glm::vec3& reflected);
  void receive_weighted(std::uint32_t texel, const TexelSample& sample);
  void receive_side(std::uint32_t side, float weight, const TexelSample::SideLight& light);
  void miss(std::uint32_t texel);
  void begin_window();
  void end_bounce();
  std::size_t texel_count() const { return albedo_.size(); }
  std::size_t side_count() const { return 2 * albedo_.size(); }

  SolutionSettings settings_;
  std::int64_t directions_ = 0;     ///< done
  float direction_weight_ = 1.0F;   ///< of the one at hand
  std::vector<glm::vec3> albedo_;   ///< per texel
  std::vector<glm::vec3> emitted_;  ///< per side, as all below; empty if bundles carry none
  std::vector<glm::vec3> known_;
  Received received_;
  std::vector<glm::vec3> total_;  ///< jacobi: sum of the bounces done
  std::vector<glm::vec3> sent_;
  std::vector<glm::vec3> next_sent_;
  GlossyTransfer* glossy_ = nullptr;
  std::vector<glm::vec3> sent_by_all_;  ///< with what lobes send; empty without them
};

}  // namespace renderers::ray_bundles

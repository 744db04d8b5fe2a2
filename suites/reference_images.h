#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "perception/image_file.h"
#include "suites/suite_file.h"

namespace suites {

/// What a reference image is of; its hash is the folder's name.
struct ReferenceKey {
  const renderers::scene::Scene* scene = nullptr;
  base::SizePx size_px;
  renderers::Claims claims;  ///< part `all`
  ReferenceSpec spec;        ///< with `own` only where it makes these claims
  /// An own picture that was stored without its AOVs is made again. No part of what it is of.
  bool needs_aovs = false;
  std::string hash() const;  ///< over scene hash, camera, size, transport, clamp, renderer + params
};

struct Reference {
  std::string hash;
  std::filesystem::path folder;
  perception::Image all;  ///< direct + indirect
  perception::Image indirect;
  perception::Image variance;                ///< of the pixel means of `all`
  std::vector<perception::NamedImage> aovs;  ///< of an own picture; as its renderer made them
  std::int64_t samples = 0;
  std::shared_ptr<const nlohmann::ordered_json> info;  ///< reference.json

  const perception::Image& image(renderers::Part part) const {
    return part == renderers::Part::all ? all : indirect;
  }
};

/// The stored references under <results>/references/<hash>/.
class ReferenceStore {
 public:
  explicit ReferenceStore(std::filesystem::path results_root);

  /// Loads a reference, renders it if it is missing, or adds samples if it has fewer than asked.
  /// It is rendered in independent pieces that are kept when it is stopped.
  /// @param progress  called with the fraction done; returns false to stop (throws Interrupted)
  Reference get(const ReferenceKey& key, const renderers::Devices& devices,
                const std::function<bool(double fraction)>& progress);
  /// True if a reference is stored with as many samples as asked, or more.
  bool contains(const ReferenceKey& key) const;
  /// Hash of the stored pixels as they are now; "" if nothing is stored.
  std::string pixel_hash_of(const ReferenceKey& key) const;
  /// Samples of the stored reference; 0 if there is none.
  std::int64_t samples_of(const ReferenceKey& key) const;
  /// What is stored, whatever its samples; nothing if there is none. Never renders.
  std::optional<Reference> load(const ReferenceKey& key) const;
  /// Every stored reference's reference.json, with its folder and whether its image can be read.
  std::vector<nlohmann::ordered_json> list() const;
  /// Renders again with another seed and fewer samples, compares with the stored image by z-test
  /// per pixel and of the image's mean: {"ok","pixels","outside_3_sigma","expected_outside",
  /// "worst_pixel":[x,y],"worst_z","mean_z","samples":[stored, rendered again]}.
  nlohmann::ordered_json verify(const ReferenceKey& key, const renderers::Devices& devices);
  /// Adds samples (further independent seeds) and stores the weighted mean.
  Reference extend(const ReferenceKey& key, std::int64_t samples, const renderers::Devices& devices,
                   const std::function<bool(double fraction)>& progress);

 private:
  Reference up_to(const ReferenceKey& key, std::int64_t samples, bool is_added,
                  const renderers::Devices& devices,
                  const std::function<bool(double fraction)>& progress);

  std::filesystem::path root_;
};

}  // namespace suites

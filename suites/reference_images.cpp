#include "suites/reference_images.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/image_file.h"
#include "results/run_environment.h"
#include "suites/file_lock.h"
#include "suites/interruption.h"
#include "suites/reference_check.h"
#include "suites/reference_rendering.h"

namespace suites {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kImageFile = "reference.exr";
constexpr const char* kInfoFile = "reference.json";
/// A long reference is stored this often while it is rendered.
constexpr double kStorePeriod_s = 10.0;
/// `verify` renders this part of the stored samples, at least kMinVerifySamples: fewer miss the
/// rare bright paths and with them most of their own variance.
constexpr std::int64_t kVerifyShare = 4;
constexpr std::int64_t kMinVerifySamples = 256;
/// In at least so many pieces: a renderer tells its variance from the spread of a few means, and
/// only many such pieces make z as good as normal.
constexpr std::int64_t kVerifyPieces = 8;

/// Seeds of a reference's pieces: far from each other, from those of `verify`, and from the small
/// numbers that methods are given, so that a reference never shares samples with what it judges.
std::uint64_t piece_seed(std::string_view purpose, std::uint64_t seed, std::uint64_t index) {
  base::Hasher hasher;
  hasher.add(purpose);
  hasher.add(static_cast<std::int64_t>(seed));
  hasher.add(static_cast<std::int64_t>(index));
  return hasher.finish().low;
}

Json camera_to_json(const renderers::scene::Camera& camera) {
  const auto list = [](const glm::vec3& v) { return Json{v.x, v.y, v.z}; };
  return Json{{"position", list(camera.position)},
              {"look_at", list(camera.look_at)},
              {"up", list(camera.up)},
              {"vertical_fov_deg", camera.vertical_fov_deg}};
}

Json read_info(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kInfoFile;
  try {
    return Json::parse(base::read_text_file(path));
  } catch (const nlohmann::json::exception& error) {
    throw base::InputError(
        fmt::format("{}: not a reference's description: {}; delete the folder "
                    "to render it again",
                    path.string(), error.what()));
  }
}

std::vector<perception::NamedImage> read_parts(const std::filesystem::path& folder) {
  try {
    return perception::read_image_file(folder / kImageFile).parts;
  } catch (const base::InputError& error) {
    throw base::InputError(
        fmt::format("{}; delete the folder to render the reference again", error.what()));
  }
}

/// A reference on its way: what is stored, and the pieces it consists of.
struct Stored {
  ReferenceEstimate estimate;
  Json chunks = Json::array();  ///< [{"seed","samples"}]
  double seconds = 0.0;
};

/// Whether AOVs are asked for and the picture was stored before any were kept.
bool lacks_aovs(const ReferenceKey& key, const Json& info) {
  return key.needs_aovs && key.spec.own && !info.contains("aovs");
}

Stored load_stored(const ReferenceKey& key, const std::filesystem::path& folder) {
  Stored stored;
  if (!std::filesystem::exists(folder / kInfoFile)) return stored;
  const Json info = read_info(folder);
  if (lacks_aovs(key, info)) return stored;
  for (perception::NamedImage& part : read_parts(folder)) {
    if (part.name == "radiance") {
      stored.estimate.all = std::move(part.image);
    } else if (part.name == "indirect") {
      stored.estimate.indirect = std::move(part.image);
    } else if (part.name == "variance") {
      stored.estimate.variance = std::move(part.image);
    } else {
      stored.estimate.aovs.push_back(std::move(part));
    }
  }
  try {
    const std::string pixel_hash = info.at("pixel_hash").get<std::string>();
    if (perception::pixel_hash(stored.estimate.all) != pixel_hash) {
      throw base::InputError(fmt::format(
          "{}: is not the image that {} describes (its pixels were changed, or storing it was cut "
          "short); delete the folder to render it again",
          (folder / kImageFile).string(), kInfoFile));
    }
    stored.estimate.samples = info.at("samples").get<std::int64_t>();
    stored.chunks = info.at("chunks");
    stored.seconds = info.at("seconds").get<double>();
  } catch (const nlohmann::json::exception& error) {
    throw base::InputError(fmt::format("{}: {}", (folder / kInfoFile).string(), error.what()));
  }
  return stored;
}

Json info_of(const ReferenceKey& key, const MethodChoice& method, const Stored& stored) {
  Json parameters = method.parameters.to_json();
  parameters.erase("samples");
  Json info{
      {"schema", results::kSchemaVersion},
      {"hash", key.hash()},
      {"scene", key.scene->name},
      {"scene_hash", key.scene->hash.hex()},
      {"frame", key.scene->frame_index},
      {"camera", camera_to_json(key.scene->camera)},
      {"size_px", {key.size_px.width, key.size_px.height}},
      {"transport", to_string(key.claims.transport)},
      {"geometry_clamp", key.claims.geometry_clamp ? Json(*key.claims.geometry_clamp) : Json()},
      {"renderer", method.info->name},
      {"renderer_version", method.info->version},
      {"preset", method.preset},
      {"parameters", parameters},
      {"samples", stored.estimate.samples},
      {"chunks", stored.chunks},
      {"seconds", stored.seconds},
      {"pixel_hash", perception::pixel_hash(stored.estimate.all)},
      {"has_variance", !stored.estimate.variance.is_empty()},
      {"machine", results::machine_name()},
      {"updated_utc", base::utc_now()}};
  if (!key.spec.own) return info;
  info["aovs"] = Json::array();
  for (const perception::NamedImage& aov : stored.estimate.aovs) info["aovs"].push_back(aov.name);
  return info;
}

/// Image first, description last: a description always has its image.
void store(const std::filesystem::path& folder, const ReferenceKey& key, const MethodChoice& method,
           const Stored& stored) {
  perception::ImageFile file;
  file.parts.push_back({"radiance", stored.estimate.all});
  if (!stored.estimate.indirect.is_empty()) {
    file.parts.push_back({"indirect", stored.estimate.indirect});
  }
  if (!stored.estimate.variance.is_empty()) {
    file.parts.push_back({"variance", stored.estimate.variance});
  }
  for (const perception::NamedImage& aov : stored.estimate.aovs) file.parts.push_back(aov);
  file.attributes.text["discern:reference"] = key.hash();
  file.attributes.text["discern:scene_hash"] = key.scene->hash.hex();
  file.attributes.text["discern:renderer"] = method.info->name;
  file.attributes.number[perception::kLuminanceScaleAttribute] = key.scene->luminance_scale_cd_m2;
  file.attributes.number["discern:samples"] = static_cast<double>(stored.estimate.samples);
  perception::write_exr(folder / kImageFile, file);
  base::write_text_file(folder / kInfoFile, info_of(key, method, stored).dump(1) + "\n");
}

/// Renders pieces until there are enough samples; stores now and then, and when it is stopped.
void render_up_to(std::int64_t samples, const ReferenceKey& key, const renderers::Devices& devices,
                  const std::filesystem::path& folder, Stored& stored,
                  const std::function<bool(double)>& progress) {
  ReferenceRenderer renderer(key, devices);
  const std::int64_t at_once = chunk_samples(key.size_px);
  const auto may_go_on = [&] {
    const double fraction =
        static_cast<double>(stored.estimate.samples) / static_cast<double>(samples);
    return !interrupt_requested && (!progress || progress(fraction));
  };
  double stored_at_s = renderers::steady_seconds();
  bool is_stopped = !may_go_on();
  while (!is_stopped && stored.estimate.samples < samples) {
    const std::int64_t left = samples - stored.estimate.samples;
    // An own picture is one piece, with the very seed of the methods.
    const std::uint64_t seed =
        key.spec.own ? key.spec.seed : piece_seed("piece", key.spec.seed, stored.chunks.size());
    const std::int64_t wanted = key.spec.own ? left : piece_samples(left, at_once);
    const double start_s = renderers::steady_seconds();
    const ReferenceEstimate piece = renderer.render(wanted, seed);
    merge(stored.estimate, piece);
    stored.chunks.push_back(Json{{"seed", seed}, {"samples", piece.samples}});
    stored.seconds += renderers::steady_seconds() - start_s;
    is_stopped = !may_go_on();
    const bool is_due = renderers::steady_seconds() - stored_at_s > kStorePeriod_s;
    if (is_due || is_stopped || stored.estimate.samples >= samples) {
      store(folder, key, renderer.method(), stored);
      stored_at_s = renderers::steady_seconds();
    }
  }
  if (stored.estimate.samples < samples) throw Interrupted();
}

Reference reference_of(Stored stored, const ReferenceKey& key,
                       const std::filesystem::path& folder) {
  Reference reference;
  reference.hash = key.hash();
  reference.folder = folder;
  reference.all = std::move(stored.estimate.all);
  reference.indirect = std::move(stored.estimate.indirect);
  reference.variance = std::move(stored.estimate.variance);
  reference.aovs = std::move(stored.estimate.aovs);
  reference.samples = stored.estimate.samples;
  reference.info = std::make_shared<const Json>(read_info(folder));
  return reference;
}

}  // namespace

std::string ReferenceKey::hash() const {
  const MethodChoice method = reference_method(*this);
  base::Hasher hasher;
  hasher.add(scene->hash.hex());
  for (const glm::vec3& v : {scene->camera.position, scene->camera.look_at, scene->camera.up}) {
    for (int i = 0; i < 3; ++i) hasher.add(static_cast<double>(v[i]));
  }
  hasher.add(static_cast<double>(scene->camera.vertical_fov_deg));
  hasher.add(std::int64_t{size_px.width});
  hasher.add(std::int64_t{size_px.height});
  hasher.add(to_string(claims.transport));
  hasher.add(claims.geometry_clamp.value_or(0.0));
  hasher.add(method.info->name);
  hasher.add(std::int64_t{method.info->version});
  // How many samples there are is a property of what is stored, not of what it is an image of.
  for (const auto& [name, value] : method.parameters.entries()) {
    if (name != "samples") hasher.add(name + "=" + base::to_json(value).dump());
  }
  // An own picture is of its samples and its seed, not an estimate that more of them improve.
  if (spec.own) hasher.add(fmt::format("samples={} seed={}", spec.samples, spec.seed));
  return hasher.finish().hex();
}

ReferenceStore::ReferenceStore(std::filesystem::path results_root)
    : root_(std::move(results_root) / "references") {}

bool ReferenceStore::contains(const ReferenceKey& key) const {
  return samples_of(key) >= key.spec.samples;
}

std::int64_t ReferenceStore::samples_of(const ReferenceKey& key) const {
  const std::filesystem::path folder = root_ / key.hash();
  if (!std::filesystem::exists(folder / kInfoFile)) return 0;
  const Json info = read_info(folder);
  return lacks_aovs(key, info) ? 0 : info.value("samples", std::int64_t{0});
}

std::string ReferenceStore::pixel_hash_of(const ReferenceKey& key) const {
  const std::filesystem::path folder = root_ / key.hash();
  if (!std::filesystem::exists(folder / kInfoFile)) return {};
  return read_info(folder).value("pixel_hash", "");
}

std::optional<Reference> ReferenceStore::load(const ReferenceKey& key) const {
  if (samples_of(key) == 0) return std::nullopt;
  const std::filesystem::path folder = root_ / key.hash();
  return reference_of(load_stored(key, folder), key, folder);
}

Reference ReferenceStore::get(const ReferenceKey& key, const renderers::Devices& devices,
                              const std::function<bool(double fraction)>& progress) {
  if (contains(key)) return *load(key);
  return up_to(key, key.spec.samples, false, devices, progress);
}

Reference ReferenceStore::extend(const ReferenceKey& key, std::int64_t samples,
                                 const renderers::Devices& devices,
                                 const std::function<bool(double fraction)>& progress) {
  if (key.spec.own) {
    throw base::InputError(
        fmt::format("reference of {}: is one picture of {}, to which no samples can be added",
                    key.scene->name, key.spec.renderer));
  }
  return up_to(key, samples, true, devices, progress);
}

Reference ReferenceStore::up_to(const ReferenceKey& key, std::int64_t samples, bool is_added,
                                const renderers::Devices& devices,
                                const std::function<bool(double fraction)>& progress) {
  const std::filesystem::path folder = root_ / key.hash();
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw base::InputError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  }
  // Another process may be rendering the same reference: wait, then use what it made.
  const FileLock lock(folder / "lock",
                      [&] { return !interrupt_requested && (!progress || progress(0.0)); });
  Stored stored = load_stored(key, folder);
  const std::int64_t target = is_added ? stored.estimate.samples + samples : samples;
  if (stored.estimate.samples < target) {
    render_up_to(target, key, devices, folder, stored, progress);
  }
  return reference_of(std::move(stored), key, folder);
}

std::vector<nlohmann::ordered_json> ReferenceStore::list() const {
  std::vector<std::filesystem::path> folders;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(root_, error)) {
    if (std::filesystem::exists(entry.path() / kInfoFile)) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  std::vector<Json> infos;
  for (const std::filesystem::path& folder : folders) {
    Json info{{"hash", folder.filename().string()}};
    try {
      info = read_info(folder);
      perception::read_image(folder / kImageFile);
      info["is_readable"] = true;
    } catch (const base::InputError& unreadable) {
      info["is_readable"] = false;
      info["reason"] = unreadable.what();
    }
    info["folder"] = folder.string();
    infos.push_back(std::move(info));
  }
  return infos;
}

nlohmann::ordered_json ReferenceStore::verify(const ReferenceKey& key,
                                              const renderers::Devices& devices) {
  const std::filesystem::path folder = root_ / key.hash();
  if (samples_of(key) == 0) {
    throw base::InputError(
        fmt::format("{}: there is no reference to verify; build it first", folder.string()));
  }
  const Stored stored = load_stored(key, folder);
  if (stored.estimate.variance.is_empty()) {
    throw base::InputError(fmt::format(
        "{}: the reference has no variance; a z-test needs a renderer that estimates it, e.g. path",
        folder.string()));
  }
  ReferenceRenderer renderer(key, devices);
  const std::int64_t samples = std::min(
      stored.estimate.samples, std::max(kMinVerifySamples, stored.estimate.samples / kVerifyShare));
  const std::int64_t at_once =
      std::clamp(samples / kVerifyPieces, std::int64_t{1}, chunk_samples(key.size_px));
  ReferenceEstimate again;
  for (std::uint64_t i = 0; i == 0 || again.samples + at_once <= samples; ++i) {
    if (interrupt_requested) throw Interrupted();
    merge(again, renderer.render(at_once, piece_seed("verify", key.spec.seed, i)));
  }
  return z_test(stored.estimate, again);
}

}  // namespace suites

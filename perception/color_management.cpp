#include "perception/color_management.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>

#include <OpenColorIO/OpenColorIO.h>

#include "perception/aces_config.h"
#include "perception/base/errors.h"

namespace perception {
namespace {

namespace ocio = OCIO_NAMESPACE;

constexpr const char* kInterchangeRole = "aces_interchange";
/// Names of ACES2065-1 in configurations without the role, older than OpenColorIO 2.
constexpr std::array<const char*, 3> kInterchangeNames{"ACES2065-1", "ACES - ACES2065-1",
                                                       "lin_ap0"};

/// The environment's configuration, or null for the embedded one.
const char* environment_config() {
  const char* path = std::getenv("OCIO");
  return path != nullptr && *path != '\0' ? path : nullptr;
}

ocio::ConstConfigRcPtr load_config(const char* path) {
  try {
    if (path != nullptr) return ocio::Config::CreateFromFile(path);
    std::istringstream text(aces_config());
    return ocio::Config::CreateFromStream(text);
  } catch (const std::exception& error) {
    throw base::InputError(
        fmt::format("$OCIO: {}: cannot be read as an OpenColorIO configuration: {}",
                    path != nullptr ? path : "embedded", error.what()));
  }
}

/// The configuration's name for ACES2065-1.
std::string interchange_space(const ocio::Config& config, const std::string& origin) {
  if (config.hasRole(kInterchangeRole)) return kInterchangeRole;
  for (const char* name : kInterchangeNames) {
    if (config.getColorSpace(name)) return name;
  }
  throw base::InputError(fmt::format(
      "$OCIO: {}: does not say which colour space is ACES2065-1; accepted: a role {}, or "
      "a colour space named {}",
      origin, kInterchangeRole, fmt::join(kInterchangeNames, ", ")));
}

void require_known(const char* kind, const std::string& name,
                   const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    throw base::InputError(base::unknown_name(kind, name, known));
  }
}

}  // namespace

struct ColorManagement::State {
  explicit State(const char* path)
      : origin(path != nullptr ? path : "embedded"),
        config(load_config(path)),
        interchange(interchange_space(*config, origin)) {}

  Image apply(Image rgb, const ocio::ConstTransformRcPtr& transform) const {
    try {
      const ocio::ConstCPUProcessorRcPtr processor =
          config->getProcessor(transform)->getDefaultCPUProcessor();
      ocio::PackedImageDesc pixels(rgb.pixels.data(), rgb.width_px, rgb.height_px, 3);
      processor->apply(pixels);
      return rgb;
    } catch (const ocio::Exception& error) {
      throw base::InputError(fmt::format("OpenColorIO ({}): {}", origin, error.what()));
    }
  }

  std::string origin;
  ocio::ConstConfigRcPtr config;
  std::string interchange;
};

namespace {

ocio::MatrixTransformRcPtr rec709_matrix(ocio::TransformDirection direction) {
  const ocio::MatrixTransformRcPtr matrix = ocio::MatrixTransform::Create();
  matrix->setMatrix(kAcesFromRec709.data());
  matrix->setDirection(direction);
  return matrix;
}

bool is_data_view(const ocio::Config& config, const std::string& display, const std::string& view) {
  const std::string name = config.getDisplayViewColorSpaceName(display.c_str(), view.c_str());
  const ocio::ConstColorSpaceRcPtr space = config.getColorSpace(name.c_str());
  return space && space->isData();
}

}  // namespace

ColorManagement::ColorManagement() : state_(std::make_unique<State>(environment_config())) {}

ColorManagement::~ColorManagement() = default;

std::vector<std::string> ColorManagement::displays() const {
  std::vector<std::string> names;
  for (int i = 0; i < state_->config->getNumDisplays(); ++i) {
    names.emplace_back(state_->config->getDisplay(i));
  }
  return names;
}

std::vector<std::string> ColorManagement::views(const std::string& display) const {
  require_known("display", display, displays());
  std::vector<std::string> names;
  for (int i = 0; i < state_->config->getNumViews(display.c_str()); ++i) {
    names.emplace_back(state_->config->getView(display.c_str(), i));
  }
  return names;
}

std::string ColorManagement::default_display() const { return state_->config->getDefaultDisplay(); }

std::string ColorManagement::default_view(const std::string& display) const {
  require_known("display", display, displays());
  return state_->config->getDefaultView(display.c_str());
}

std::string ColorManagement::origin() const { return state_->origin; }

Image ColorManagement::view(const Image& scene_linear, const std::string& display,
                            const std::string& view) const {
  require_known("view", view, views(display));
  if (scene_linear.encoding != Encoding::scene_linear) {
    throw base::InputError(fmt::format("a view is of scene-linear images; this one is {}",
                                       to_string(scene_linear.encoding)));
  }
  Image rgb = rgb_of(scene_linear);
  rgb.encoding = Encoding::display;
  if (is_data_view(*state_->config, display, view)) return rgb;

  const ocio::DisplayViewTransformRcPtr shown = ocio::DisplayViewTransform::Create();
  shown->setSrc(state_->interchange.c_str());
  shown->setDisplay(display.c_str());
  shown->setView(view.c_str());
  const ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
  group->appendTransform(rec709_matrix(ocio::TRANSFORM_DIR_FORWARD));
  group->appendTransform(shown);
  return state_->apply(std::move(rgb), group);
}

Image ColorManagement::to_scene_linear_rec709(const Image& image,
                                              const std::string& color_space) const {
  if (!state_->config->getColorSpace(color_space.c_str())) {
    std::vector<std::string> known;
    for (int i = 0; i < state_->config->getNumColorSpaces(); ++i) {
      known.emplace_back(state_->config->getColorSpaceNameByIndex(i));
    }
    throw base::InputError(base::unknown_name("colour space", color_space, known));
  }
  const ocio::ColorSpaceTransformRcPtr convert = ocio::ColorSpaceTransform::Create();
  convert->setSrc(color_space.c_str());
  convert->setDst(state_->interchange.c_str());
  const ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
  group->appendTransform(convert);
  group->appendTransform(rec709_matrix(ocio::TRANSFORM_DIR_INVERSE));
  Image rgb = rgb_of(image);
  rgb.encoding = Encoding::scene_linear;
  return state_->apply(std::move(rgb), group);
}

}  // namespace perception

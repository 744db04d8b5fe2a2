#pragma once

#include <map>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace renderers {

/// Base of what renderers keep between their lives: a graphics context with its compiled shaders.
/// Never anything of a scene.
class WarmState {
 public:
  virtual ~WarmState() = default;
};

/// Things kept warm by name, e.g. "opengl/auto". Used by one thread at a time.
using WarmStore = std::map<std::string, std::shared_ptr<WarmState>>;

/// Where a renderer may run. Created by the harness, passed to a renderer's `create`.
struct Devices {
  int threads = 0;                  ///< 0: one per core
  std::string platform = "auto";    ///< auto | egl-device | egl-surfaceless | osmesa
  std::shared_ptr<WarmStore> warm;  ///< shared by the renderers of a process; null: nothing is kept
};

/// The device cannot do what the method needs here: no GL driver, a map beyond its limits. The
/// harness records `unsupported` with this reason and goes on.
class UnsupportedError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The device has no memory left for what was asked. The harness records `out_of_memory`.
class DeviceMemoryError : public std::bad_alloc {
 public:
  explicit DeviceMemoryError(const std::string& message)
      : message_(std::make_shared<const std::string>(message)) {}
  const char* what() const noexcept override { return message_->c_str(); }

 private:
  std::shared_ptr<const std::string> message_;  ///< shared: copies of exceptions must not throw
};

/// What a graphics platform offers, from a trial context.
struct DeviceFacts {
  std::string platform;  ///< egl-device | egl-surfaceless | osmesa
  std::string renderer;  ///< GL_RENDERER
  std::string vendor;    ///< GL_VENDOR
  std::string version;   ///< GL_VERSION
  bool is_software = false;
  std::vector<std::pair<std::string, double>> limits;  ///< "max_texture_size_px": 16384, ...
};

}  // namespace renderers

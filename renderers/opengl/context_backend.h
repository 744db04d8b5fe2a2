#pragma once

#include <functional>
#include <memory>

#include "renderers/opengl/context.h"

namespace renderers::opengl {

/// A platform's own part of a context.
class Context::Backend {
 public:
  virtual ~Backend() = default;
  /// Makes it current on this thread; no context of another library may be.
  /// @throws base::DeviceError
  virtual void make_current() = 0;
  /// Leaves the thread that calls it without a current context of this library. Outlives the
  /// backend.
  virtual std::function<void()> release() const = 0;
  /// Of an entry point by its full name; null if there is none.
  virtual void (*address_of(const char* name) const)() = 0;
};

/// @throws UnsupportedError with what the platform answered
std::unique_ptr<Context::Backend> open_egl_device();
std::unique_ptr<Context::Backend> open_egl_surfaceless();
std::unique_ptr<Context::Backend> open_osmesa();

}  // namespace renderers::opengl

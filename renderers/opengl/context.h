#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderers/contract/devices.h"

/// OpenGL 4.5 core without a window: contexts, resources, shaders, the scene on the device.
///
/// Every object of this kit belongs to one Context and keeps it alive. A context is used by the
/// thread that made it; any call makes it current if another one is. The libraries are opened at
/// the first need; $DISCERN_EGL_LIBRARY and $DISCERN_OSMESA_LIBRARY name others than the system's.
namespace renderers::opengl {

struct Functions;  // the entry points, gl_functions.h
class Program;
struct ProgramSource;

enum class Platform { egl_device, egl_surfaceless, osmesa };
std::string to_string(Platform platform);  ///< "egl-device", ...
/// Names of the platforms in the order `auto` tries them.
std::vector<std::string> platform_names();

/// What the driver allows.
struct Limits {
  std::int64_t texture_size_px = 0;
  std::int64_t array_layers = 0;
  std::int64_t storage_block_bytes = 0;
  std::int64_t storage_blocks = 0;           ///< of one compute shader
  std::int64_t vertex_storage_blocks = 0;    ///< of one vertex shader; may be 0
  std::int64_t fragment_storage_blocks = 0;  ///< of one fragment shader
  std::int64_t storage_bindings = 0;         ///< places that blocks are bound to
  std::int64_t work_group_invocations = 0;
  std::int64_t work_groups = 0;  ///< of one dispatch, along each axis
  std::int64_t shared_memory_bytes = 0;
  std::int64_t image_units = 0;
  bool has_vertex_layers = false;  ///< vertex shaders may choose gl_Layer
};

class Context : public WarmState, public std::enable_shared_from_this<Context> {
 public:
  ~Context() override;

  /// A new context. `auto`: an EGL device that is no software, EGL surfaceless, OSMesa, the first
  /// that works.
  /// @param platform  auto | egl-device | egl-surfaceless | osmesa
  /// @throws UnsupportedError if no such platform gives OpenGL 4.5 core, naming what was tried and
  ///   what each answered; base::InputError for an unknown name
  static std::shared_ptr<Context> create(const std::string& platform);

  /// The context of `devices.platform` in `devices.warm`, created at the first call and after a
  /// loss. The first context of a process limits a software driver to `devices.threads`.
  static std::shared_ptr<Context> of(const Devices& devices);

  /// The context of `devices` if it draws in hardware, else null, also where there is none. Under
  /// `auto` no software context is made to find out.
  /// @throws base::InputError for an unknown name
  static std::shared_ptr<Context> hardware_of(const Devices& devices);

  Platform platform() const { return platform_; }
  const DeviceFacts& facts() const { return facts_; }
  const Limits& limits() const { return limits_; }
  /// True for a driver that draws on the CPU, whose timer queries say nothing about raster passes.
  bool is_software() const { return facts_.is_software; }

  /// True once `check` has found it lost: everything made in it is gone.
  bool is_lost() const;

  /// Makes the context current on this thread and returns its entry points.
  const Functions& use();

  /// A program compiled at its first use and kept; see program.h.
  /// @throws base::DeviceError naming shader file, line and the driver's log
  Program& program(const ProgramSource& source);

  /// Waits until the device has done everything.
  void finish();

  /// Messages of KHR_debug with severity medium or high since the last call, oldest first.
  std::vector<std::string> take_messages();

  /// @throws base::DeviceError if an error, a high-severity message or a reset is pending;
  ///   DeviceMemoryError if the device ran out of memory
  /// @param doing  what was done, for the message: "gathering"
  void check(std::string_view doing);

  class Backend;  // one per platform

 private:
  struct Content;
  Context(Platform platform, std::unique_ptr<Backend> backend);

  Platform platform_;
  DeviceFacts facts_;
  Limits limits_;
  std::unique_ptr<Content> content_;
};

/// Facts of a platform from a trial context. @throws as Context::create
DeviceFacts probe(const std::string& platform);

}  // namespace renderers::opengl

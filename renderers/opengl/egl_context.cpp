#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <fmt/core.h>

#include "perception/base/errors.h"
#include "renderers/opengl/context_backend.h"
#include "renderers/opengl/shared_library.h"

namespace renderers::opengl {

namespace {

struct EglFunctions {
  PFNEGLBINDAPIPROC BindAPI = nullptr;
  PFNEGLCREATECONTEXTPROC CreateContext = nullptr;
  PFNEGLDESTROYCONTEXTPROC DestroyContext = nullptr;
  PFNEGLGETERRORPROC GetError = nullptr;
  PFNEGLGETPROCADDRESSPROC GetProcAddress = nullptr;
  PFNEGLINITIALIZEPROC Initialize = nullptr;
  PFNEGLMAKECURRENTPROC MakeCurrent = nullptr;
  PFNEGLQUERYSTRINGPROC QueryString = nullptr;
  PFNEGLGETPLATFORMDISPLAYEXTPROC GetPlatformDisplay = nullptr;
};

/// True if a list of words separated by blanks holds the word.
bool has_word(const char* list, std::string_view word) {
  if (list == nullptr) return false;
  std::istringstream words(list);
  std::string each;
  while (words >> each) {
    if (each == word) return true;
  }
  return false;
}

void require_extension(const char* list, const char* name) {
  if (!has_word(list, name)) throw UnsupportedError(fmt::format("EGL lacks {}", name));
}

EglFunctions load_egl() {
  const SharedLibrary library({"libEGL.so.1", "libEGL.so"}, "DISCERN_EGL_LIBRARY",
                              "libegl1 and libgl1-mesa-dri");
  EglFunctions egl;
  library.load(egl.BindAPI, "eglBindAPI");
  library.load(egl.CreateContext, "eglCreateContext");
  library.load(egl.DestroyContext, "eglDestroyContext");
  library.load(egl.GetError, "eglGetError");
  library.load(egl.GetProcAddress, "eglGetProcAddress");
  library.load(egl.Initialize, "eglInitialize");
  library.load(egl.MakeCurrent, "eglMakeCurrent");
  library.load(egl.QueryString, "eglQueryString");
  require_extension(egl.QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_EXT_platform_base");
  egl.GetPlatformDisplay = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      egl.GetProcAddress("eglGetPlatformDisplayEXT"));
  return egl;
}

/// A context without a surface on a display. Displays are shared by the whole process and never
/// terminated: that would end the contexts of others.
class EglBackend : public Context::Backend {
 public:
  EglBackend(const EglFunctions& egl, EGLenum platform, void* native_display) : egl_(egl) {
    display_ = egl_.GetPlatformDisplay(platform, native_display, nullptr);
    if (display_ == EGL_NO_DISPLAY) throw refusal("eglGetPlatformDisplayEXT");
    if (egl_.Initialize(display_, &major_, &minor_) == EGL_FALSE) throw refusal("eglInitialize");
    const char* extensions = egl_.QueryString(display_, EGL_EXTENSIONS);
    require_extension(extensions, "EGL_KHR_no_config_context");
    require_extension(extensions, "EGL_KHR_surfaceless_context");
    if (egl_.BindAPI(EGL_OPENGL_API) == EGL_FALSE) throw refusal("eglBindAPI(EGL_OPENGL_API)");
    if (has_word(extensions, "EGL_EXT_create_context_robustness")) context_ = create(true);
    if (context_ == EGL_NO_CONTEXT) context_ = create(false);
    if (context_ == EGL_NO_CONTEXT) throw refusal("eglCreateContext of OpenGL 4.5 core");
  }
  ~EglBackend() override { egl_.DestroyContext(display_, context_); }
  EglBackend(const EglBackend&) = delete;
  EglBackend& operator=(const EglBackend&) = delete;

  void make_current() override {
    if (egl_.MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
      throw base::DeviceError(fmt::format("eglMakeCurrent failed: {:#x}", egl_.GetError()));
    }
  }
  std::function<void()> release() const override {
    return [make_current = egl_.MakeCurrent, display = display_] {
      make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    };
  }
  void (*address_of(const char* name) const)() override { return egl_.GetProcAddress(name); }

 private:
  /// A debug context; a robust one tells when it is lost instead of ending the process.
  EGLContext create(bool is_robust) {
    const bool has_1_5 = major_ > 1 || minor_ >= 5;
    std::vector<EGLint> attributes{
        EGL_CONTEXT_MAJOR_VERSION,       4,
        EGL_CONTEXT_MINOR_VERSION,       5,
        EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    if (has_1_5) attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
    if (has_1_5 && is_robust) {
      attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE,
                                           EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                           EGL_LOSE_CONTEXT_ON_RESET});
    }
    attributes.push_back(EGL_NONE);
    return egl_.CreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  }

  UnsupportedError refusal(const char* step) const {
    return UnsupportedError(fmt::format("{} failed: {:#x}", step, egl_.GetError()));
  }

  EglFunctions egl_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  EGLint major_ = 0;
  EGLint minor_ = 0;
};

/// The devices that are hardware. @throws UnsupportedError if there are none
std::vector<EGLDeviceEXT> hardware_devices(const EglFunctions& egl) {
  const char* extensions = egl.QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  require_extension(extensions, "EGL_EXT_platform_device");
  const auto query_devices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.GetProcAddress("eglQueryDevicesEXT"));
  const auto query_string = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
      egl.GetProcAddress("eglQueryDeviceStringEXT"));
  if (query_devices == nullptr || query_string == nullptr) {
    throw UnsupportedError("EGL lacks EGL_EXT_device_query");
  }
  EGLint count = 0;
  query_devices(0, nullptr, &count);
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(std::max(count, 0)));
  query_devices(count, devices.data(), &count);
  const auto listed = devices.size();
  std::erase_if(devices, [&](EGLDeviceEXT device) {
    return has_word(query_string(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
  });
  if (devices.empty()) {
    throw UnsupportedError(
        fmt::format("no EGL device is hardware ({} listed, all software)", listed));
  }
  return devices;
}

}  // namespace

std::unique_ptr<Context::Backend> open_egl_device() {
  const EglFunctions egl = load_egl();
  std::string answers;
  for (EGLDeviceEXT device : hardware_devices(egl)) {
    try {
      return std::make_unique<EglBackend>(egl, EGL_PLATFORM_DEVICE_EXT, device);
    } catch (const UnsupportedError& error) {
      answers += (answers.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  throw UnsupportedError("no EGL device works: " + answers);
}

std::unique_ptr<Context::Backend> open_egl_surfaceless() {
  const EglFunctions egl = load_egl();
  require_extension(egl.QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS),
                    "EGL_MESA_platform_surfaceless");
  return std::make_unique<EglBackend>(egl, EGL_PLATFORM_SURFACELESS_MESA, nullptr);
}

}  // namespace renderers::opengl

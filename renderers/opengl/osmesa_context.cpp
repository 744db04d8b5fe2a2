#include <array>
#include <cstdint>

#include <GL/osmesa.h>

#include "perception/base/errors.h"
#include "renderers/opengl/context_backend.h"
#include "renderers/opengl/shared_library.h"

namespace renderers::opengl {

namespace {

struct OsMesaFunctions {
  decltype(&OSMesaCreateContextAttribs) CreateContextAttribs = nullptr;
  decltype(&OSMesaDestroyContext) DestroyContext = nullptr;
  decltype(&OSMesaMakeCurrent) MakeCurrent = nullptr;
  decltype(&OSMesaGetProcAddress) GetProcAddress = nullptr;
};

OsMesaFunctions load_osmesa() {
  const SharedLibrary library({"libOSMesa.so.8", "libOSMesa.so"}, "DISCERN_OSMESA_LIBRARY",
                              "libosmesa6");
  OsMesaFunctions osmesa;
  library.load(osmesa.CreateContextAttribs, "OSMesaCreateContextAttribs");
  library.load(osmesa.DestroyContext, "OSMesaDestroyContext");
  library.load(osmesa.MakeCurrent, "OSMesaMakeCurrent");
  library.load(osmesa.GetProcAddress, "OSMesaGetProcAddress");
  return osmesa;
}

class OsMesaBackend : public Context::Backend {
 public:
  OsMesaBackend() : osmesa_(load_osmesa()) {
    const std::array<int, 11> attributes{OSMESA_FORMAT,
                                         OSMESA_RGBA,
                                         OSMESA_PROFILE,
                                         OSMESA_CORE_PROFILE,
                                         OSMESA_CONTEXT_MAJOR_VERSION,
                                         4,
                                         OSMESA_CONTEXT_MINOR_VERSION,
                                         5,
                                         0};
    context_ = osmesa_.CreateContextAttribs(attributes.data(), nullptr);
    if (context_ == nullptr) throw UnsupportedError("OSMesa gives no OpenGL 4.5 core context");
  }
  ~OsMesaBackend() override { osmesa_.DestroyContext(context_); }

  void make_current() override {
    if (osmesa_.MakeCurrent(context_, pixels_.data(), GL_UNSIGNED_BYTE, kSize_px, kSize_px) == 0) {
      throw base::DeviceError("OSMesaMakeCurrent failed");
    }
  }
  std::function<void()> release() const override {
    return [make_current = osmesa_.MakeCurrent] { make_current(nullptr, nullptr, 0, 0, 0); };
  }
  void (*address_of(const char* name) const)() override { return osmesa_.GetProcAddress(name); }

 private:
  static constexpr int kSize_px = 16;  ///< OSMesa wants a picture; nothing is ever drawn into it

  OsMesaFunctions osmesa_;
  OSMesaContext context_ = nullptr;
  std::array<std::uint8_t, 4 * kSize_px * kSize_px> pixels_{};
};

}  // namespace

std::unique_ptr<Context::Backend> open_osmesa() { return std::make_unique<OsMesaBackend>(); }

}  // namespace renderers::opengl

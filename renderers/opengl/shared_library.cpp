#include "renderers/opengl/shared_library.h"

#include <dlfcn.h>

#include <cstdlib>

#include "renderers/contract/devices.h"

namespace renderers::opengl {

SharedLibrary::SharedLibrary(const std::vector<std::string>& names, const char* override_variable,
                             const std::string& packages) {
  const char* chosen = std::getenv(override_variable);
  const std::vector<std::string> candidates =
      chosen != nullptr ? std::vector<std::string>{chosen} : names;
  std::string reason;
  for (const std::string& name : candidates) {
    name_ = name;
    handle_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle_ != nullptr) return;
    if (reason.empty()) reason = dlerror();
  }
  throw UnsupportedError("cannot open " + candidates.front() + " (" + reason +
                         "); Debian packages with it: " + packages);
}

void* SharedLibrary::symbol(const char* name) const {
  void* address = dlsym(handle_, name);
  if (address == nullptr) throw UnsupportedError(name_ + " lacks the function " + name);
  return address;
}

}  // namespace renderers::opengl

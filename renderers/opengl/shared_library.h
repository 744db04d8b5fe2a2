#pragma once

#include <string>
#include <vector>

namespace renderers::opengl {

/// A library of the system, opened at run time and never closed (drivers do not survive that).
class SharedLibrary {
 public:
  /// The first of the names that opens, or the file that an environment variable names.
  /// @param override_variable  name of that environment variable
  /// @param packages           Debian packages that hold the library, for the message
  /// @throws UnsupportedError naming library, reason and packages
  SharedLibrary(const std::vector<std::string>& names, const char* override_variable,
                const std::string& packages);

  /// @throws UnsupportedError if the library has no such symbol
  template <typename Pointer>
  void load(Pointer& entry, const char* name) const {
    entry = reinterpret_cast<Pointer>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;

  void* handle_ = nullptr;
  std::string name_;
};

}  // namespace renderers::opengl

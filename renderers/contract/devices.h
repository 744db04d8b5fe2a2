#pragma once

#include <string>

namespace renderers {

/// Where a renderer may run. Created by the harness, passed to a renderer's `create`.
struct Devices {
  int threads = 0;                ///< 0: one per core
  std::string platform = "auto";  ///< auto | egl-device | egl-surfaceless | osmesa
};

}  // namespace renderers

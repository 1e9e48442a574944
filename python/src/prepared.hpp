#pragma once
#include "common.hpp"

namespace microtrace::python {

/// The content of microtrace.PreparedScene.
struct Prepared {
  PreparedScene scene;
  bool is_flat = false;         ///< pictures are flat by default
  bool has_background = false;  ///< Scene.background is not None
};

}  // namespace microtrace::python

#pragma once
#include "common.hpp"

#include <memory>

namespace microtrace::python {

/// Python's handle to an image, which is shared with the scenes that are made from Python.
struct SharedImage {
  std::shared_ptr<const Image> image;
};

struct SharedMap {
  std::shared_ptr<const RadianceMap> map;
};

}  // namespace microtrace::python

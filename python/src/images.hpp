#pragma once
#include "common.hpp"

#include <memory>

namespace microtrace::python {

/// Python's handle of an image. A scene made from Python shares it.
struct SharedImage {
  std::shared_ptr<const Image> image;
};

struct SharedMap {
  std::shared_ptr<const RadianceMap> map;
};

}  // namespace microtrace::python

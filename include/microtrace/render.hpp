#pragma once
/// From a scene to a picture.

#include <microtrace/camera.hpp>
#include <microtrace/film.hpp>
#include <microtrace/scene.hpp>

#include <functional>

namespace microtrace {

struct RenderOptions {
  unsigned threads = 0;  ///< 0: default_threads()
  /// Told the share of the picture that is done, in (0, 1]; by one thread at a time, not always the
  /// caller's.
  std::function<void(double)> progress{};
};

/// One ray through each pixel's centre takes the colour of what it hits first in (scene.epsilon,
/// infinity), or the background. The picture does not depend on the options. Throws Error (limit)
/// where memory or primitive numbers run out.
[[nodiscard]] Film render(const Scene& scene, const Camera& camera, ImageSize size,
                          const RenderOptions& options = {});

}  // namespace microtrace

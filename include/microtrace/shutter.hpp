#pragma once
/// Motion blur.

#include <microtrace/camera.hpp>
#include <microtrace/prepared_scene.hpp>

#include <cstdint>
#include <functional>

namespace microtrace {

/// The times at which a picture with motion blur shows the scene: the middles of `count` equal
/// slices of the time during which the shutter is open.
struct ShutterTimes {
  double open = 0, close = 0;  ///< seconds, finite; open must not be after close
  std::uint32_t count = 64;    ///< a power of two, at most kMaxSamples

  /// The number of different times: 1 if the shutter closes at once.
  [[nodiscard]] std::uint32_t slices() const { return open == close ? 1 : count; }
  /// The time of a slice in seconds; slices are counted from 0.
  [[nodiscard]] double time(std::uint32_t slice) const {
    return open + (close - open) * ((slice + 0.5) / slices());
  }
};

/// A scene and a camera at one time. The camera is in the coordinates of this scene.
struct Moment {
  PreparedScene scene;
  Camera camera;
};

/// A shutter for RenderOptions. Each sample sees the scene at one of the times. In each pixel,
/// samples k * count to (k + 1) * count - 1 have different times for any k, and the first 2^n
/// samples are spread evenly over the times. The time of a sample is a function of the random seed,
/// the pixel and the sample's index.
struct Shutter {
  ShutterTimes times{};
  /// Returns the scene and the camera at a time, always the same for the same time. Called in each
  /// pass once for every slice in ascending order, on the thread that called render(). The renderer
  /// keeps only the latest result.
  std::function<Moment(double time)> moment{};
};

}  // namespace microtrace

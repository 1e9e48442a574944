#pragma once
/// The pictures of one run: one per frame, or a single one.

#include "cli/arguments.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/io.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace microtrace::cli {

class Sequence {
 public:
  /// The arguments must outlive this object.
  explicit Sequence(const Arguments& arguments) : arguments_(arguments) {}

  [[nodiscard]] std::uint32_t count() const;
  /// Returns the animation time of picture `index` in seconds; absent if the scene is rendered
  /// without animation. `index` counts from 0.
  [[nodiscard]] std::optional<double> time(std::uint32_t index) const;
  [[nodiscard]] std::filesystem::path picture(std::uint32_t index) const;
  [[nodiscard]] std::filesystem::path sidecar(std::uint32_t index) const;
  [[nodiscard]] std::filesystem::path checkpoint(std::uint32_t index) const;
  /// Returns the checkpoints to continue from.
  [[nodiscard]] std::vector<std::filesystem::path> resume(std::uint32_t index) const;
  /// Returns the checkpoints to merge.
  [[nodiscard]] std::vector<std::filesystem::path> checkpoints(std::uint32_t index) const;
  /// Returns the number of the frame; absent if there are no frames.
  [[nodiscard]] std::optional<std::uint32_t> frame(std::uint32_t index) const;

 private:
  [[nodiscard]] std::filesystem::path path(const std::filesystem::path& name,
                                           std::uint32_t index) const;
  [[nodiscard]] std::vector<std::filesystem::path> paths(
      const std::vector<std::filesystem::path>& names, std::uint32_t index) const;

  const Arguments& arguments_;
};

/// Returns a static camera that frames all pictures of a sequence, in world coordinates. Absent if
/// the sequence uses a camera of the scene or is a single picture. Loads the scene at the time of
/// every picture.
[[nodiscard]] std::optional<PerspectiveCamera> frame_all(SceneFile& file, const Sequence& sequence,
                                                         const Arguments& arguments);

}  // namespace microtrace::cli

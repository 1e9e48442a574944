#pragma once
#include "cli/arguments.hpp"
#include "cli/sample_files.hpp"
#include "cli/sequence.hpp"
#include "cli/statistics.hpp"
#include "cli/warnings.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>

namespace microtrace::cli {

/// Where a picture is written.
struct PictureFiles {
  std::filesystem::path picture;
  std::filesystem::path sidecar;   ///< empty: none
  SampleFiles* samples = nullptr;  ///< where samples are read and written; null: nowhere
};

/// Throws the Error that the paths of a sequence's pictures would end in, before any work.
void check_outputs(const Arguments& arguments, const Sequence& sequence);

/// Shows the progress of so many pictures as the arguments ask for; may be empty.
[[nodiscard]] std::function<void(double)> progress_of(const Arguments& arguments,
                                                      std::uint32_t pictures);

/// Renders a scene, to which apply_environment() was applied, and writes the picture and the
/// sidecar; for a shard only its samples. Warns of a picture that shows nothing before it is
/// written.
void make_picture(Scene scene, const Camera& camera, ImageSize size, const Arguments& arguments,
                  const PictureFiles& files, RenderCache& cache, Stopwatch& watch,
                  Warnings& warnings, const std::function<void(double)>& progress);

}  // namespace microtrace::cli

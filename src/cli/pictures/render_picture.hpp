#pragma once
#include "cli/arguments.hpp"
#include "cli/pictures/sample_files.hpp"
#include "cli/pictures/sequence.hpp"
#include "cli/report/statistics.hpp"
#include "cli/report/warnings.hpp"

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

/// Throws the Error that writing a sequence's pictures to their paths would throw; called before
/// rendering.
void check_outputs(const Arguments& arguments, const Sequence& sequence);

/// Reports the progress of this number of pictures as --progress asks; may be empty.
[[nodiscard]] std::function<void(double)> progress_of(const Arguments& arguments,
                                                      std::uint32_t pictures);

/// Shared by the pictures of a sequence: those of the last one.
using Tables = std::shared_ptr<const SharedTables>;

/// Renders a scene, to which apply_environment() was applied, and writes the picture and the
/// sidecar; for a shard only its samples. Warns of a picture that shows nothing before it is
/// written.
void render_picture(Scene scene, const Camera& camera, ImageSize size, const Arguments& arguments,
                    const PictureFiles& files, Tables& tables, Stopwatch& watch, Warnings& warnings,
                    const std::function<void(double)>& progress);

}  // namespace microtrace::cli

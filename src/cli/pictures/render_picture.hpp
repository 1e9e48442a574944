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

/// The files of a picture.
struct PictureFiles {
  std::filesystem::path picture;
  std::filesystem::path sidecar;   ///< empty: none
  SampleFiles* samples = nullptr;  ///< the checkpoints to read and write; null: none
};

/// Throws the errors that writing the pictures of a sequence to their paths would throw. Called
/// before rendering.
void check_outputs(const Arguments& arguments, const Sequence& sequence);

/// A function that reports progress over `pictures` pictures according to --progress; may be empty.
[[nodiscard]] std::function<void(double)> progress_of(const Arguments& arguments,
                                                      std::uint32_t pictures);

/// The tables of the last picture of a sequence, for the next.
using Tables = std::shared_ptr<const SharedTables>;

/// Renders a scene, to which apply_environment() was applied, and writes the picture and the
/// sidecar; for a shard only its samples. Warns before writing a picture that shows nothing.
void render_picture(Scene scene, const Camera& camera, ImageSize size, const Arguments& arguments,
                    const PictureFiles& files, Tables& tables, Stopwatch& watch, Warnings& warnings,
                    const std::function<void(double)>& progress);

}  // namespace microtrace::cli

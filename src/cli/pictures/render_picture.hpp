#pragma once
#include "cli/arguments.hpp"
#include "cli/pictures/display_server.hpp"
#include "cli/pictures/sample_files.hpp"
#include "cli/pictures/sequence.hpp"
#include "cli/report/statistics.hpp"
#include "cli/report/warnings.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/denoise.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/shutter.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

namespace microtrace::cli {

/// The files of a picture, the server that shows it, and its denoiser.
struct PictureFiles {
  std::filesystem::path picture;
  std::filesystem::path sidecar;   ///< empty if no sidecar is written
  SampleFiles* samples = nullptr;  ///< the checkpoints to read and write; null if there are none
  DisplayServer* display_server = nullptr;  ///< null if there is none
  const Denoiser* denoiser = nullptr;       ///< null if the picture is not denoised
};

/// Throws the errors that writing a sequence's pictures to their paths would throw. Called before
/// rendering.
void check_outputs(const Arguments& arguments, const Sequence& sequence);

/// Returns the function that reports the progress of rendering `pictures` pictures as --progress
/// requests. The function may be empty.
[[nodiscard]] std::function<void(double)> progress_of(const Arguments& arguments,
                                                      std::uint32_t pictures);

/// The tables of a sequence's previous picture, for reuse by the next picture.
using Tables = std::shared_ptr<const SharedTables>;

/// Renders a scene to which apply_environment() has been applied. Writes the picture and the
/// sidecar, or only the samples if a shard is rendered. Warns before writing a picture that shows
/// nothing. `shutter` is absent without --shutter.
void render_picture(Scene scene, const Camera& camera, ImageSize size, const Arguments& arguments,
                    const PictureFiles& files, std::optional<Shutter> shutter, Tables& tables,
                    Stopwatch& watch, Warnings& warnings,
                    const std::function<void(double)>& progress);

}  // namespace microtrace::cli

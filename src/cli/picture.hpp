#pragma once
#include "cli/arguments.hpp"
#include "cli/sample_files.hpp"
#include "cli/statistics.hpp"
#include "cli/warnings.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/scene.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>

namespace microtrace::cli {

/// What a picture is written to.
struct PictureFiles {
  std::filesystem::path picture;
  std::filesystem::path sidecar;   ///< or none
  SampleFiles* samples = nullptr;  ///< which samples come from and go to; null: none
};

/// Throws the Error that stands against the pictures that the arguments ask for, before any work.
void check_outputs(const Arguments& arguments, const std::filesystem::path& output,
                   const std::filesystem::path& sidecar);

/// What shows the progress of so many pictures, as the arguments ask for; may be empty.
[[nodiscard]] std::function<void(double)> progress_of(const Arguments& arguments,
                                                      std::uint32_t pictures = 1);

/// Draws a picture of a scene with the surroundings that the arguments ask for and writes it, with
/// its sidecar if that has a name; of a shard the samples alone. Tells the watch, and warns of a
/// picture that shows nothing, before it is written.
void make_picture(Scene scene, const Camera& camera, ImageSize size, const Arguments& arguments,
                  const PictureFiles& files, RenderCache& cache, Stopwatch& watch,
                  Warnings& warnings, const std::function<void(double)>& progress);

}  // namespace microtrace::cli

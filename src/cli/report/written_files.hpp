#pragma once
/// The line on standard error that lists the files that a run has written.

#include <microtrace/film.hpp>

#include <cstdint>
#include <filesystem>

namespace microtrace::cli {

struct WrittenFiles {
  std::filesystem::path main;     ///< a picture or a checkpoint; "-" is standard output
  std::filesystem::path sidecar;  ///< empty if there is none
};

/// Prints a line like "wrote a.png: 640 x 480 pixels, 64 samples each, exposure -2.5, in 1.2 s".
/// Names the exposure only if it changes the picture. Prints nothing about files that are standard
/// output.
void report_written(const WrittenFiles& files, ImageSize size, std::uint32_t samples,
                    const Display& display, double seconds);

}  // namespace microtrace::cli

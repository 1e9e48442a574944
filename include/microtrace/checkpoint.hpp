#pragma once
/// Files of samples: what an interrupted run goes on from, and what machines that share a picture
/// bring together.

#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/sample_sums.hpp>

#include <cstdint>
#include <filesystem>
#include <string>

namespace microtrace {

/// The samples of a picture, and what picture it is.
struct Checkpoint {
  /// All that the samples depend on: lines of a name, a tab and a value. Files whose samples may be
  /// added have the same.
  std::string identity;
  bool has_alpha = false;     ///< of the picture
  std::uint32_t samples = 1;  ///< that the run was to take for each pixel
  Display display{};          ///< of its light: exposure and tone map
  SampleSums sums{};
};

/// Writes a checkpoint; the file appears whole or not at all. Throws Error (io).
MICROTRACE_EXPORT void save_checkpoint(const Checkpoint& checkpoint,
                                       const std::filesystem::path& path);

/// Reads one. Throws Error (io) also where the file is none, was written by another version, or is
/// not as it was written.
[[nodiscard]] MICROTRACE_EXPORT Checkpoint load_checkpoint(const std::filesystem::path& path);

/// Adds the samples of `other`, which was read from `path`; takes them where `checkpoint` has no
/// sums yet. Throws Error (usage) where they are another picture's, and says what differs, or where
/// some are here already.
MICROTRACE_EXPORT void add_samples(Checkpoint& checkpoint, Checkpoint other,
                                   const std::filesystem::path& path);

/// The picture of its samples.
[[nodiscard]] MICROTRACE_EXPORT Film picture_of(const Checkpoint& checkpoint);

/// Throws the Error that save_checkpoint would throw at once, and writes nothing.
MICROTRACE_EXPORT void check_checkpoint_path(const std::filesystem::path& path);

}  // namespace microtrace

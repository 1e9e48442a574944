#pragma once
/// Files of samples: an interrupted run resumes from them, and machines that share a picture merge
/// them.

#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/sample_sums.hpp>

#include <cstdint>
#include <filesystem>
#include <string>

namespace microtrace {

/// The samples of a picture, and the identity of the picture.
struct Checkpoint {
  /// Everything that the samples depend on: lines with a name, a tab and a value. Only files with
  /// equal identities may be merged.
  std::string identity;
  bool has_alpha = false;     ///< true if the picture has alpha
  std::uint32_t samples = 1;  ///< requested samples per pixel
  Display display{};          ///< exposure and tone map of the picture
  SampleSums sums{};
};

/// Writes a checkpoint; the file appears whole or not at all. Throws Error (io).
MICROTRACE_EXPORT void save_checkpoint(const Checkpoint& checkpoint,
                                       const std::filesystem::path& path);

/// Reads a checkpoint. Throws Error (io) also if the file is not a checkpoint, has another version,
/// or is damaged.
[[nodiscard]] MICROTRACE_EXPORT Checkpoint load_checkpoint(const std::filesystem::path& path);

/// Adds the samples of `other`, which was read from `path`; moves them if `checkpoint` has no sums
/// yet. Throws Error (usage) if they belong to another picture, naming the difference, or if some
/// of them are already present.
MICROTRACE_EXPORT void add_samples(Checkpoint& checkpoint, Checkpoint other,
                                   const std::filesystem::path& path);

/// The picture of the checkpoint's samples.
[[nodiscard]] MICROTRACE_EXPORT Film picture_of(const Checkpoint& checkpoint);

/// Throws the Error that save_checkpoint would throw immediately, without writing.
MICROTRACE_EXPORT void check_checkpoint_path(const std::filesystem::path& path);

}  // namespace microtrace

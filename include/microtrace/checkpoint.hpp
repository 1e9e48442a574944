#pragma once
/// Checkpoints store the samples of a picture in a file. An interrupted run resumes from its
/// checkpoint, and the checkpoints of several machines that render the same picture can be merged.

#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/read_files.hpp>
#include <microtrace/sample_sums.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace microtrace {

/// The samples of a picture and a description that identifies the picture.
struct Checkpoint {
  /// Lists everything that the samples depend on, in lines of a name, a tab and a value. Only
  /// checkpoints with equal identities may be merged.
  std::string identity;
  bool has_alpha = false;                     ///< true if the picture has alpha
  bool has_lens = false, has_ground = false;  ///< those of the film
  std::uint32_t samples = 1;                  ///< requested samples per pixel
  Display display{};                          ///< how 8-bit formats show the picture
  SampleSums sums{};
  /// Other channels of the picture. compute_channels() computes some of them from the sums, so
  /// their values are not saved.
  std::vector<Channel> channels{};
  /// Names of the channels that are only there for denoising, sorted; the picture lacks them.
  std::vector<std::string> only_for_denoising{};
  /// The file from which it was loaded, which errors name; empty if there is none.
  std::filesystem::path file{};
};

/// Writes a checkpoint; the file appears whole or not at all. Throws Error: io if it can't be
/// written, usage if the path can't name a file.
MICROTRACE_EXPORT void save_checkpoint(const Checkpoint& checkpoint,
                                       const std::filesystem::path& path);

/// Does the same if the file doesn't exist or is in the state `known`. Returns false if it was
/// written since, also by another process at the same time. Throws Error as save_checkpoint does.
[[nodiscard]] MICROTRACE_EXPORT bool replace_checkpoint(const Checkpoint& checkpoint,
                                                        const std::filesystem::path& path,
                                                        const FileState& known);

/// Reads a checkpoint. Throws Error: io if the file can't be read, is not a checkpoint, has a
/// different version, or is damaged; unsupported if the module that decompresses it is missing.
[[nodiscard]] MICROTRACE_EXPORT Checkpoint load_checkpoint(const std::filesystem::path& path);

/// Adds the samples of `other`, which was read from `path`, to `checkpoint`; moves them if
/// `checkpoint` has no samples yet. Throws Error (usage) if they belong to a different picture, or
/// if some of them are already present. The message names the differences between the pictures. The
/// display becomes that of the checkpoint with the first samples, so checkpoints may be added in
/// any order. The channels are those of the checkpoints with the most requested samples; those for
/// denoising become channels of the picture if they are in one of these checkpoints.
MICROTRACE_EXPORT void add_samples(Checkpoint& checkpoint, Checkpoint other,
                                   const std::filesystem::path& path);

/// Returns the picture of the checkpoint's samples.
[[nodiscard]] MICROTRACE_EXPORT Film picture_of(const Checkpoint& checkpoint);

/// Throws the Error with which save_checkpoint would fail at once for this path. Writes nothing.
MICROTRACE_EXPORT void check_checkpoint_path(const std::filesystem::path& path);

}  // namespace microtrace

#pragma once
/// Reads and writes checkpoints during rendering.

#include "base/memory_account.hpp"
#include "cli/arguments.hpp"
#include "cli/pictures/sequence.hpp"

#include <microtrace/checkpoint.hpp>
#include <microtrace/read_files.hpp>
#include <microtrace/render.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace microtrace::cli {

/// Reads these checkpoints and adds their samples to `all`. Charges the memory of `all` to `memory`
/// if it has no samples yet. `keeps_channels` is false if the channels are rendered again.
void add_files(Checkpoint& all, std::span<const std::filesystem::path> files, MemoryAccount& memory,
               bool keeps_channels);

class SampleFiles {
 public:
  /// Reads and combines the checkpoints of a picture of the sequence. `files` is a digest of all
  /// the scene's files. `arguments` must outlive this object. Throws Error.
  SampleFiles(const Arguments& arguments, const Sequence& sequence, std::uint32_t index,
              std::uint64_t files);
  SampleFiles(const SampleFiles&) = delete;
  SampleFiles& operator=(const SampleFiles&) = delete;

  /// Warnings about samples beyond --spp.
  [[nodiscard]] std::vector<Diagnostic> warnings() const;

  /// Returns passes for RenderOptions that continue from the samples read and save samples every
  /// --save-every seconds. Progressive pictures are encoded with `display`.
  [[nodiscard]] Passes passes(const Display& display);

  /// Adds the channels of the complete picture to the checkpoint of a shard, which is all that is
  /// left of the picture.
  void keep(const Film& film);

  /// False before the first pass.
  [[nodiscard]] bool has_samples() const { return !samples_.sums.pixels.empty(); }

  /// Writes the checkpoint if there is one and there are samples. Throws Error (io) if another
  /// program has written the file since this one read or wrote it.
  void save();

  /// The file of --checkpoint; empty if there is none.
  [[nodiscard]] const std::filesystem::path& checkpoint() const { return checkpoint_; }

 private:
  /// Writes the checkpoint. Returns false if another program has written it.
  [[nodiscard]] bool write();
  [[noreturn]] void fail_as_foreign() const;
  void save_if_due();

  const Arguments& arguments_;
  std::filesystem::path checkpoint_, picture_;
  FileState known_;  ///< of the checkpoint, as this program read or wrote it
  Checkpoint samples_;
  MemoryAccount memory_;  ///< memory of samples that were read
  std::chrono::steady_clock::time_point saved_;
  bool has_warned_ = false;  ///< that a file could not be written
};

}  // namespace microtrace::cli

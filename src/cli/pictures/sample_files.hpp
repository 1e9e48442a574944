#pragma once
/// Reads and writes checkpoints during rendering.

#include "base/memory_account.hpp"
#include "cli/arguments.hpp"

#include <microtrace/checkpoint.hpp>
#include <microtrace/render.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace microtrace::cli {

/// Reads these checkpoints and adds their samples to `all`. Charges the memory of `all` to `memory`
/// if it has no samples yet.
void add_files(Checkpoint& all, std::span<const std::filesystem::path> files,
               MemoryAccount& memory);

class SampleFiles {
 public:
  /// Reads and combines the checkpoints that the options specify. `files` is a digest of all the
  /// scene's files. `arguments` must outlive this object. Throws Error.
  SampleFiles(const Arguments& arguments, std::uint64_t files);
  SampleFiles(const SampleFiles&) = delete;
  SampleFiles& operator=(const SampleFiles&) = delete;

  /// Warnings about samples beyond --spp.
  [[nodiscard]] std::vector<Diagnostic> warnings() const;

  /// Returns passes for RenderOptions that continue from the samples read and save samples every
  /// --save-every seconds. Progressive pictures are encoded with `display`.
  [[nodiscard]] Passes passes(const Display& display);

  /// Writes the checkpoint of --checkpoint if the option is given.
  void save() const;

 private:
  void save_if_due();

  const Arguments& arguments_;
  Checkpoint samples_;
  MemoryAccount memory_;  ///< memory of samples that were read
  std::chrono::steady_clock::time_point saved_;
};

}  // namespace microtrace::cli

#pragma once
/// The checkpoints that are read and written while rendering.

#include "cli/arguments.hpp"

#include <microtrace/checkpoint.hpp>
#include <microtrace/render.hpp>

#include <chrono>
#include <cstdint>
#include <vector>

namespace microtrace::cli {

class SampleFiles {
 public:
  /// Reads and combines the checkpoints that the options name. `files` is the digest of all files
  /// that the scene was read from. Throws Error. The arguments must outlive it.
  SampleFiles(const Arguments& arguments, std::uint64_t files);
  SampleFiles(const SampleFiles&) = delete;
  SampleFiles& operator=(const SampleFiles&) = delete;

  /// About samples beyond --spp.
  [[nodiscard]] std::vector<Diagnostic> warnings() const;

  /// For RenderOptions: continues from these samples and saves them every --save-every seconds;
  /// progressive pictures are encoded as `display` says.
  [[nodiscard]] Passes passes(const Display& display);

  /// Writes the checkpoint of --checkpoint, if it is given.
  void save() const;

 private:
  void save_if_due();

  const Arguments& arguments_;
  Checkpoint samples_;
  std::chrono::steady_clock::time_point saved_;
};

}  // namespace microtrace::cli

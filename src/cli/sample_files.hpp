#pragma once
/// The files that samples come from and go to while a picture is made.

#include "cli/arguments.hpp"

#include <microtrace/checkpoint.hpp>
#include <microtrace/render.hpp>

#include <chrono>
#include <cstdint>
#include <vector>

namespace microtrace::cli {

class SampleFiles {
 public:
  /// Reads the checkpoints that the options name, and adds them up. `files` is the digest of all
  /// files that the scene was read from. Throws Error. The arguments must outlive it.
  SampleFiles(const Arguments& arguments, std::uint64_t files);
  SampleFiles(const SampleFiles&) = delete;
  SampleFiles& operator=(const SampleFiles&) = delete;

  /// What is odd about the samples there are.
  [[nodiscard]] std::vector<Diagnostic> warnings() const;

  /// For RenderOptions: goes on from these samples, and writes them from time to time, pictures as
  /// they are to be shown.
  [[nodiscard]] Passes passes(const Display& display);

  /// Writes the checkpoint, if there is one.
  void save() const;

 private:
  void save_if_due();

  const Arguments& arguments_;
  Checkpoint samples_;
  std::chrono::steady_clock::time_point saved_;
};

}  // namespace microtrace::cli

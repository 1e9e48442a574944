#include "cli/pictures/sample_files.hpp"

#include <microtrace/io.hpp>
#include <microtrace/version.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace microtrace::cli {
namespace {

/// Returns a string of all inputs on which samples depend: the program's version, the scene's files
/// and the options.
std::string identity_of(const Arguments& arguments, std::uint64_t files) {
  return "version\t" MICROTRACE_VERSION_TEXT "\nscene files\t" + std::to_string(files) + "\n" +
         arguments.identity;
}

/// Returns the checkpoints to continue from, without duplicates.
std::vector<std::filesystem::path> files_of(const SamplingOptions& sampling) {
  std::vector<std::filesystem::path> files = sampling.resume;
  std::error_code ignored;
  const bool is_new = std::ranges::none_of(files, [&](const std::filesystem::path& file) {
    return std::filesystem::equivalent(file, sampling.checkpoint, ignored);
  });
  if (std::filesystem::exists(sampling.checkpoint, ignored) && is_new)
    files.push_back(sampling.checkpoint);
  return files;
}

}  // namespace

void add_files(Checkpoint& all, std::span<const std::filesystem::path> files,
               MemoryAccount& memory) {
  for (const std::filesystem::path& file : files) {
    MemoryAccount temporary(memory.budget());
    const MemoryScope scope(all.sums.pixels.empty() ? memory : temporary);
    add_samples(all, load_checkpoint(file), file);
  }
}

SampleFiles::SampleFiles(const Arguments& arguments, std::uint64_t files)
    : arguments_(arguments),
      samples_{.identity = identity_of(arguments, files),
               .has_alpha = arguments.environment.is_transparent(),
               .samples = arguments.sampling.samples},
      memory_(arguments.load.memory),
      saved_(std::chrono::steady_clock::now()) {
  add_files(samples_, files_of(arguments.sampling), memory_);
}

std::vector<Diagnostic> SampleFiles::warnings() const {
  const std::uint32_t wanted = arguments_.sampling.samples;
  const std::vector<SampleRange>& ranges = samples_.sums.ranges();
  if (ranges.empty() || ranges.back().last <= wanted) return {};
  Diagnostic more;
  more.message = "the checkpoints contain samples up to number " +
                 std::to_string(ranges.back().last) + " of each pixel, more than --spp " +
                 std::to_string(wanted) + "; the picture uses all of them";
  return {more};
}

Passes SampleFiles::passes(const Display& display) {
  samples_.display = display;
  return {.sums = &samples_.sums,
          .part = arguments_.sampling.range(),
          .target_error = arguments_.sampling.target_error,
          .time_limit = arguments_.sampling.time_limit,
          .after_each = [this](const SampleSums&) { save_if_due(); }};
}

void SampleFiles::save() const {
  const std::filesystem::path& file = arguments_.sampling.checkpoint;
  if (!file.empty() && !samples_.sums.pixels.empty()) save_checkpoint(samples_, file);
}

void SampleFiles::save_if_due() {
  const auto now = std::chrono::steady_clock::now();
  if (std::chrono::duration<double>(now - saved_).count() < arguments_.sampling.save_every) return;
  save();
  if (arguments_.sampling.is_progressive) {
    save_image(picture_of(samples_), arguments_.output, arguments_.ppm);
  }
  saved_ = std::chrono::steady_clock::now();
}

}  // namespace microtrace::cli

#include "cli/pictures/sample_files.hpp"

#include "cli/report/progress_bar.hpp"

#include <microtrace/denoise.hpp>
#include <microtrace/error.hpp>
#include <microtrace/io.hpp>
#include <microtrace/version.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace microtrace::cli {
namespace {

/// Returns a string of all inputs on which samples depend: the program's version, the scene's
/// files, the options and the frame.
std::string identity_of(const Arguments& arguments, std::uint64_t files,
                        std::optional<std::uint32_t> frame) {
  std::string identity = "version\t" MICROTRACE_VERSION_TEXT "\nscene files\t" +
                         std::to_string(files) + "\n" + arguments.identity;
  if (frame) identity += "frame\t" + std::to_string(*frame) + "\n";
  return identity;
}

/// Adds the checkpoint to those to continue from if it exists and is not one of them.
std::vector<std::filesystem::path> with_checkpoint(std::vector<std::filesystem::path> files,
                                                   const std::filesystem::path& checkpoint) {
  std::error_code ignored;
  const bool is_new = std::ranges::none_of(files, [&](const std::filesystem::path& file) {
    return std::filesystem::equivalent(file, checkpoint, ignored);
  });
  if (std::filesystem::exists(checkpoint, ignored) && is_new) files.push_back(checkpoint);
  return files;
}

}  // namespace

void add_files(Checkpoint& all, std::span<const std::filesystem::path> files, MemoryAccount& memory,
               bool keeps_channels) {
  for (const std::filesystem::path& file : files) {
    MemoryAccount temporary(memory.budget());
    const MemoryScope scope(all.sums.pixels.empty() ? memory : temporary);
    Checkpoint next = load_checkpoint(file);
    if (!keeps_channels) {
      next.channels.clear();
      next.only_for_denoising.clear();
    }
    add_samples(all, std::move(next), file);
  }
}

SampleFiles::SampleFiles(const Arguments& arguments, const Sequence& sequence, std::uint32_t index,
                         std::uint64_t files)
    : arguments_(arguments),
      checkpoint_(sequence.checkpoint(index)),
      picture_(sequence.picture(index)),
      known_(state_of(checkpoint_)),
      samples_{.identity = identity_of(arguments, files, sequence.frame(index)),
               .has_alpha = arguments.environment.is_transparent(),
               .samples = arguments.sampling.samples},
      memory_(arguments.load.memory),
      saved_(std::chrono::steady_clock::now()) {
  add_files(samples_, with_checkpoint(sequence.resume(index), checkpoint_), memory_, false);
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
          .range = arguments_.sampling.range(),
          .target_error = arguments_.sampling.target_error,
          .time_limit = arguments_.sampling.time_limit,
          .after_each = [this](const SampleSums&) { save_if_due(); }};
}

void SampleFiles::keep(const Film& film) {
  if (!arguments_.sampling.shard) return;
  memory_.take(film.channels.size() * samples_.sums.pixels.size() * sizeof(float),
               "the channels of a checkpoint");
  samples_.channels = film.channels;
  samples_.only_for_denoising = channels_only_for_denoising(film.channels, arguments_.aovs.sampled);
  samples_.has_lens = film.has_lens;
  samples_.has_ground = film.has_ground;
}

void SampleFiles::save() {
  if (checkpoint_.empty() || !has_samples()) return;
  if (!write()) fail_as_foreign();
}

bool SampleFiles::write() {
  if (!replace_checkpoint(samples_, checkpoint_, known_)) return false;
  known_ = state_of(checkpoint_);
  return true;
}

void SampleFiles::fail_as_foreign() const {
  throw Error(ErrorKind::io, checkpoint_.string(),
              "was written by another program meanwhile; give each one a --checkpoint of its own");
}

void SampleFiles::save_if_due() {
  const auto now = std::chrono::steady_clock::now();
  if (std::chrono::duration<double>(now - saved_).count() < arguments_.sampling.save_every) return;
  bool is_ours = true;
  try {
    if (!checkpoint_.empty()) is_ours = write();
    if (is_ours && arguments_.sampling.is_progressive)
      save_image(picture_of(samples_), picture_, arguments_.ppm);
  } catch (const Error& error) {
    // A disk that is full now may have space at the end. Ending here would lose the samples.
    if (error.kind() != ErrorKind::io) throw;
    if (!has_warned_ && !arguments_.quiet) {
      clear_progress_bar();
      std::fprintf(stderr, "warning: %s; it will be tried again\n", error.what());
    }
    has_warned_ = true;
  }
  if (!is_ours) fail_as_foreign();
  saved_ = std::chrono::steady_clock::now();
}

}  // namespace microtrace::cli

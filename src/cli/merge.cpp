#include "cli/merge.hpp"

#include "base/memory_account.hpp"
#include "base/text/printable.hpp"
#include "cli/options/option_value.hpp"
#include "cli/pictures/environment.hpp"
#include "cli/pictures/exposure.hpp"
#include "cli/pictures/output_paths.hpp"
#include "cli/pictures/sample_files.hpp"
#include "cli/pictures/sequence.hpp"
#include "cli/report/written_files.hpp"

#include <microtrace/checkpoint.hpp>
#include <microtrace/denoise.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <vector>

namespace microtrace::cli {

namespace {

/// "samples 16 to 32 of 50 are missing"; empty if none are missing.
std::string missing_samples(const Checkpoint& all) {
  std::string ranges;
  for (const SampleRange& range : all.sums.missing({.first = 0, .last = all.samples})) {
    ranges.append(ranges.empty() ? "samples " : ", ").append(std::to_string(range.first));
    ranges.append(" to ").append(std::to_string(range.last - 1));
  }
  if (!ranges.empty())
    ranges.append(" of ").append(std::to_string(all.samples)).append(" are missing");
  return ranges;
}

/// Removes files that don't exist, with warnings, if samples may be missing.
void skip_missing(std::vector<std::filesystem::path>& files, const Arguments& arguments) {
  if (!arguments.frames || !arguments.allows_missing_samples) return;
  std::erase_if(files, [&](const std::filesystem::path& file) {
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) return false;
    if (!arguments.quiet)
      std::fprintf(stderr, "warning: %s is missing\n", printable(file.string()).c_str());
    return true;
  });
}

/// Returns what the picture contains. Throws Error (usage) if it can't be denoised.
FilmContents contents_of(const Checkpoint& all, bool denoises) {
  if (denoises && lacks_denoise_features(all.channels)) {
    throw Error(ErrorKind::usage, "",
                "--denoise: the checkpoints lack the channels for denoising; give --denoise to "
                "the runs with --shard too");
  }
  return {.alpha = all.has_alpha, .channels = all.channels.size() > all.only_for_denoising.size()};
}

/// Merges the checkpoints of one picture. Returns false if none exists and samples may be missing.
/// `denoiser` is null if the picture is not denoised.
bool merge_picture(const Arguments& arguments, const Sequence& sequence, std::uint32_t index,
                   const Denoiser* denoiser) {
  const auto begin = std::chrono::steady_clock::now();
  const ReadFiles inputs;
  MemoryBudget budget(arguments.memory_limit.value_or(default_memory_limit()));
  MemoryAccount memory(&budget);
  const MemoryScope scope(memory);
  std::vector<std::filesystem::path> files = sequence.checkpoints(index);
  skip_missing(files, arguments);
  if (files.empty()) return false;
  const std::filesystem::path picture = sequence.picture(index),
                              merged = sequence.checkpoint(index);
  Checkpoint all = load_checkpoint(files.front());
  if (!merged.empty()) check_checkpoint_path(merged);
  if (!picture.empty()) check_image_path(picture, {.alpha = all.has_alpha});
  check_outputs_differ({{"--output", picture}, {"--checkpoint", merged}});
  add_files(all, std::span(files).subspan(1), memory, true);
  // Any of the checkpoints may have the channels.
  if (!picture.empty()) check_image_path(picture, contents_of(all, denoiser != nullptr));
  check_no_input_is_overwritten(inputs, {{"--output", picture}, {"--checkpoint", merged}});
  const std::string missing = missing_samples(all);
  const std::string place = picture.empty() ? merged.string() : picture.string();
  if (!missing.empty() && !arguments.allows_missing_samples) {
    throw Error(ErrorKind::usage, place,
                missing +
                    "; add the checkpoints of the missing shards, or use --partial, as for runs "
                    "that --target-error or --time-limit ended");
  }
  if (!missing.empty() && !arguments.quiet)
    std::fprintf(stderr, "warning: %s: %s\n", printable(place).c_str(), missing.c_str());
  Display display;
  if (!picture.empty()) {
    Film film = picture_of(all);
    if (denoiser != nullptr) denoiser->denoise(film, {.memory = &budget});
    remove_channels(film, all.only_for_denoising);
    apply_display(film, arguments.display);
    display = film.display;
    save_image(film, picture, arguments.ppm);
  }
  if (!merged.empty()) save_checkpoint(all, merged);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  if (!arguments.quiet) {
    report_written({.main = picture.empty() ? merged : picture, .sidecar = {}},
                   all.sums.window.size(), all.sums.count(), display, seconds.count());
  }
  return true;
}

}  // namespace

void merge_samples(const Arguments& arguments) {
  refuse_automatic_exposure(arguments.display, "merge");
  if (arguments.output.empty()) {
    if (arguments.sampling.checkpoint.empty()) refuse_usage("merge needs --output or --checkpoint");
    if (arguments.denoises || arguments.display.exposure || arguments.display.tone_map)
      refuse_usage("without --output, --denoise, --exposure and --tonemap have no effect");
  }
  const Sequence sequence(arguments);
  check_paths(ReadFiles(), sequence);
  std::optional<Denoiser> denoiser;
  if (arguments.denoises && !arguments.output.empty()) denoiser.emplace();
  bool any_exists = false;
  for (std::uint32_t index = 0; index < sequence.count(); ++index)
    any_exists |= merge_picture(arguments, sequence, index, denoiser ? &*denoiser : nullptr);
  if (!any_exists)
    throw Error(ErrorKind::io, "", "none of the checkpoints exists; check the names");
}

}  // namespace microtrace::cli

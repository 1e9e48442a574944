#include "cli/merge.hpp"

#include "cli/pictures/environment.hpp"
#include "cli/pictures/output_paths.hpp"
#include "cli/report/written_files.hpp"

#include <microtrace/checkpoint.hpp>

#include <chrono>
#include <cstdio>
#include <string>

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

}  // namespace

void merge_samples(const Arguments& arguments) {
  const auto begin = std::chrono::steady_clock::now();
  const ReadFiles inputs;
  Checkpoint all = load_checkpoint(arguments.checkpoints.front());
  check_image_path(arguments.output, {.alpha = all.has_alpha});
  for (std::size_t i = 1; i < arguments.checkpoints.size(); ++i)
    add_samples(all, load_checkpoint(arguments.checkpoints[i]), arguments.checkpoints[i]);
  check_no_input_is_overwritten(inputs, {{"--output", arguments.output}});
  const std::string missing = missing_samples(all);
  if (!missing.empty() && !arguments.allows_missing_samples) {
    throw Error(ErrorKind::usage, "",
                missing + "; add the checkpoints of the missing shards, or use --partial");
  }
  if (!missing.empty() && !arguments.quiet) std::fprintf(stderr, "warning: %s\n", missing.c_str());
  Film film = picture_of(all);
  apply_display(film, arguments.display);
  save_image(film, arguments.output, arguments.ppm);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  if (!arguments.quiet) {
    report_written({.main = arguments.output, .sidecar = {}}, film.size(), all.sums.count(),
                   seconds.count());
  }
}

}  // namespace microtrace::cli

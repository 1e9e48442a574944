#include "cli/merge.hpp"

#include "cli/help.hpp"
#include "cli/outputs.hpp"
#include "cli/usage_error.hpp"
#include "cli/written.hpp"

#include <microtrace/checkpoint.hpp>

#include <chrono>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace microtrace::cli {

bool is_merge(int argc, char** argv) {
  return argc > 1 && std::string_view(argv[1]) == "merge";
}

ParsedMerge parse_merge(int argc, char** argv) {
  ParsedMerge parsed;
  MergeArguments& a = parsed.arguments;
  CLI::App app{"microtrace merge: makes one picture of the samples of several checkpoints",
               "microtrace merge"};
  set_help_format(app);
  app.add_option("CHECKPOINT", a.files, "files that --checkpoint wrote, of one picture")
      ->required()
      ->type_name("FILE");
  app.add_option("-o,--output", a.output, "picture; its ending tells the kind")
      ->required()
      ->type_name("FILE");
  app.add_option("--ppm", a.ppm, "encoding of PPM files: binary (P6) or ascii (P3) [binary]")
      ->transform(CLI::Transformer(std::map<std::string, PpmEncoding>{
          {"binary", PpmEncoding::binary}, {"ascii", PpmEncoding::ascii}}))
      ->type_name("KIND");
  add_exposure_options(app, a.exposure);
  app.add_flag("--partial", a.is_partial,
               "make a picture though samples are missing; without it that is an error");
  app.add_flag("-q,--quiet", a.quiet, "no warnings, no line about what was written");
  try {
    app.parse(argc - 1, argv + 1);
    refuse_empty_values(app);
  } catch (const CLI::ParseError& error) {
    parsed.exit_code = report(app, error);
  }
  return parsed;
}

namespace {

/// Says which samples are in none of the files; nothing if all are there.
std::string missing_samples(const Checkpoint& all) {
  std::string ranges;
  for (const SampleRange& range : all.sums.missing({.first = 0, .last = all.samples})) {
    ranges.append(ranges.empty() ? "samples " : ", ").append(std::to_string(range.first));
    ranges.append(" to ").append(std::to_string(range.last - 1));
  }
  if (!ranges.empty())
    ranges.append(" of ").append(std::to_string(all.samples)).append(" are in none of the files");
  return ranges;
}

}  // namespace

void merge_samples(const MergeArguments& arguments) {
  const auto begin = std::chrono::steady_clock::now();
  const ReadFiles inputs;
  Checkpoint all = load_checkpoint(arguments.files.front());
  check_image_path(arguments.output, {.alpha = all.has_alpha});
  for (std::size_t i = 1; i < arguments.files.size(); ++i)
    add_samples(all, load_checkpoint(arguments.files[i]), arguments.files[i]);
  refuse_to_write_over(inputs, {{"--output", arguments.output}});
  const std::string missing = missing_samples(all);
  if (!missing.empty() && !arguments.is_partial) {
    throw Error(ErrorKind::usage, "",
                missing +
                    "; add the checkpoints of the missing shards, or make a picture of what "
                    "is there by --partial");
  }
  if (!missing.empty() && !arguments.quiet) std::fprintf(stderr, "warning: %s\n", missing.c_str());
  Film film = picture_of(all);
  expose(film, arguments.exposure);
  save_image(film, arguments.output, arguments.ppm);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  if (!arguments.quiet) {
    report_written({.main = arguments.output, .sidecar = {}}, film.size(), all.sums.count(),
                   seconds.count());
  }
}

}  // namespace microtrace::cli

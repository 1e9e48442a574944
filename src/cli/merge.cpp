#include "cli/merge.hpp"

#include "cli/help.hpp"

#include <microtrace/checkpoint.hpp>

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
  app.add_flag("-q,--quiet", a.quiet, "no warnings");
  try {
    app.parse(argc - 1, argv + 1);
  } catch (const CLI::ParseError& error) {
    parsed.exit_code = app.exit(error) == 0 ? 0 : static_cast<int>(ErrorKind::usage);
  }
  return parsed;
}

void merge_samples(const MergeArguments& arguments) {
  Checkpoint all = load_checkpoint(arguments.files.front());
  check_image_path(arguments.output, {.alpha = all.has_alpha});
  for (std::size_t i = 1; i < arguments.files.size(); ++i)
    add_samples(all, load_checkpoint(arguments.files[i]), arguments.files[i]);
  const SampleRange wanted{.first = 0, .last = all.samples};
  for (const SampleRange& range : all.sums.missing(wanted)) {
    if (arguments.quiet) break;
    std::fprintf(stderr, "warning: samples %u to %u of %u are in none of the files\n", range.first,
                 range.last - 1, wanted.last);
  }
  Film film = picture_of(all);
  expose(film, arguments.exposure);
  save_image(film, arguments.output, arguments.ppm);
}

}  // namespace microtrace::cli

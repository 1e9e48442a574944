#include "cli/arguments_sampling.hpp"

#include "cli/option_values.hpp"
#include "cli/whole_numbers.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace microtrace::cli {
namespace {

/// Options that have no influence on any sample. All others must be the same where samples are put
/// together.
constexpr std::array<std::string_view, 26> kWithoutInfluence{
    "SCENE",        "--output",      "--spp",      "--samples",    "--aov",      "--sidecar",
    "--allow-path", "--threads",     "--ppm",      "--stats",      "--progress", "--strict",
    "--validate",   "--verbose",     "--exposure", "--tonemap",    "--quiet",    "--time-limit",
    "--max-time",   "--checkpoint",  "--resume",   "--save-every", "--shard",    "--progressive",
    "--help",       "--memory-limit"};

std::string identity_of(const CLI::App& app) {
  std::string identity;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 ||
        std::ranges::find(kWithoutInfluence, name) != kWithoutInfluence.end())
      continue;
    identity += name;
    char before = '\t';
    for (const std::string& value : option->results()) {
      identity += before;
      // Names may hold any bytes; these two part entries.
      for (const char c : value) identity += c == '\n' || c == '\t' ? ' ' : c;
      before = ' ';
    }
    identity += '\n';
  }
  return identity;
}

double seconds_of(const char* option, const std::string& text) {
  const double seconds = parse_number(option, text);
  if (seconds < 0) throw CLI::ValidationError(option, "wants seconds from 0 on, not " + text);
  return seconds;
}

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto index = whole_number(std::string_view(text).substr(0, slash));
  const auto count = slash == std::string::npos
                         ? std::nullopt
                         : whole_number(std::string_view(text).substr(slash + 1));
  if (!index || !count || *index < 1 || *index > *count)
    throw CLI::ValidationError("--shard", "wants I/N, part I of N, I from 1 to N, not " + text);
  return {.index = *index, .count = *count};
}

}  // namespace

void add_sampling_options(CLI::App& app, Sampling& sampling) {
  app.add_option("--spp,--samples", sampling.samples,
                 "rays for each pixel, spread over it [with light 64, else 1, through its centre]")
      ->transform(whole_number_between(1, kMaxSamples))
      ->type_name("N");
  const auto set_filter = [&sampling](const std::string& name) {
    sampling.filter = name == "box" ? PixelFilter::box : PixelFilter::blackman_harris;
  };
  app.add_option_function<std::string>(
         "--filter", set_filter,
         "how samples weigh in a pixel: box, evenly within its square, or blackman-harris, a bell "
         "3 pixels wide [box]")
      ->check(CLI::IsMember({"box", "blackman-harris"}))
      ->type_name("NAME");
  app.add_option("--seed", sampling.seed,
                 "of all that is random: another number gives other noise [0]")
      ->transform(whole_number_between(0, std::numeric_limits<std::uint32_t>::max()))
      ->type_name("N");
  app.add_option_function<std::string>(
         "--target-error",
         [&sampling](const std::string& text) {
           sampling.target_error = parse_number("--target-error", text);
           if (!(sampling.target_error > 0))
             throw CLI::ValidationError("--target-error", "must be above 0, is " + text);
         },
         "take no more samples where the picture's relative error is no higher, as 0.02; --spp is "
         "the most [take all]")
      ->type_name("E");
  app.add_option_function<std::string>(
         "--time-limit",
         [&sampling](const std::string& text) {
           sampling.time_limit = seconds_of("--time-limit", text);
         },
         "seconds after which no pass over the picture begins: it has the samples that are there "
         "then [none]")
      ->type_name("S");
  app.add_option("--checkpoint", sampling.checkpoint,
                 "file of the samples so far, written again and again and at the end; where it is "
                 "there already, its samples are taken over")
      ->type_name("FILE");
  app.add_option("--resume", sampling.resume,
                 "checkpoint whose samples are taken over; may be given more than once")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("FILE");
  app.add_option("--shard",
                 "I/N: take only part I of N of the samples, into --checkpoint; microtrace merge "
                 "makes a picture of all")
      ->needs("--checkpoint")
      ->excludes("--output")
      ->type_name("I/N");
  app.add_flag("--progressive", sampling.is_progressive,
               "write the picture while it is made, as it is then");
  app.add_option_function<std::string>(
         "--save-every",
         [&sampling](const std::string& text) {
           sampling.save_every = seconds_of("--save-every", text);
         },
         "seconds between writing checkpoints and progressive pictures [60]")
      ->type_name("S");
  for (const char* option : {"--target-error", "--time-limit", "--checkpoint", "--resume",
                             "--shard", "--progressive", "--save-every"})
    app.get_option(option)->group("Long renderings");
}

void finish_sampling(const CLI::App& app, Sampling& sampling) {
  for (const char* option : {"--checkpoint", "--resume", "--progressive"}) {
    if (app.count(option) > 0 && app.count("--frames") > 0)
      throw CLI::ExcludesError(option, "--frames");
  }
  if (app.count("--shard") > 0) {
    for (const char* option : {"--aov", "--sidecar", "--progressive", "--target-error"}) {
      if (app.count(option) > 0)
        throw CLI::ExcludesError("--shard, which makes no picture,", option);
    }
    sampling.shard = parse_shard(app.get_option("--shard")->as<std::string>());
  }
  sampling.identity = identity_of(app);
}

void check_sampling(const Sampling& sampling, bool has_light) {
  if (sampling.wants_passes() && !has_light) {
    throw Error(
        ErrorKind::usage, "",
        "checkpoints, progressive pictures, --target-error and --time-limit are for pictures "
        "with light; use --integrator path");
  }
  if (sampling.shard && sampling.shard->count > sampling.samples) {
    throw Error(ErrorKind::usage, "",
                "--shard: there are no " + std::to_string(sampling.shard->count) + " parts of " +
                    std::to_string(sampling.samples) + " samples (--spp)");
  }
}

std::optional<SampleRange> Sampling::part() const {
  if (!shard) return std::nullopt;
  const auto bound = [&](std::uint32_t index) {
    return static_cast<std::uint32_t>(std::uint64_t{samples} * index / shard->count);
  };
  return SampleRange{.first = bound(shard->index - 1), .last = bound(shard->index)};
}

}  // namespace microtrace::cli

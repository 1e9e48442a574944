#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace microtrace::cli {
namespace {

constexpr std::array kFilters{Choice<PixelFilter>{"box", PixelFilter::box},
                              Choice<PixelFilter>{"blackman-harris", PixelFilter::blackman_harris}};
constexpr std::array kBackfaces{Choice<Backfaces>{"pass", Backfaces::pass},
                                Choice<Backfaces>{"occlude", Backfaces::occlude}};
constexpr std::array kBsdfModels{Choice<BsdfModel>{"conserving", BsdfModel::conserving},
                                 Choice<BsdfModel>{"spec", BsdfModel::spec}};

std::vector<std::string> quality_names() {
  return names_of(kQualities);
}

const Quality* parse_quality(const OptionValue& value) {
  const auto* found = std::ranges::find(kQualities, value.text, &Quality::name);
  if (found == kQualities.end()) value.refuse(listed(quality_names()));
  return found;
}

constexpr std::array kSamplingOptions{
    Option{.names = "--integrator",
           .metavar = "NAME",
           .help =
               "rendering method: flat (colors without light), path (path tracing), or one of the "
               "exact quantities of --aov, which the picture then shows",
           .default_value = "path for glTF, flat for JSON",
           .samples = Samples::change,
           .words = integrator_names,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.integrator = parse_integrator(value); }},
    Option{.names = "--spp,--samples",
           .metavar = "N",
           .help = "samples per pixel, 1 to 65536; a single sample is at the pixel's center, "
                   "except with path",
           .default_value = "64 for path, else 1",
           .samples = Samples::keep,
           .set =
               [](Arguments& a, const OptionValue& value) {
                 a.sampling.samples = value.whole_number(1, kMaxSamples);
               }},
    Option{.names = "--filter",
           .metavar = "NAME",
           .help = "pixel filter: box (the pixel's square) or blackman-harris (bell-shaped, 3 "
                   "pixels wide)",
           .default_value = "box",
           .samples = Samples::change,
           .words = [] { return names_of(kFilters); },
           .set = [](Arguments& a,
                     const OptionValue& value) { a.sampling.filter = value.choice(kFilters); }},
    Option{.names = "--seed",
           .metavar = "N",
           .help = "random seed, 0 to 4294967295: a different seed gives different noise",
           .default_value = "0",
           .samples = Samples::change,
           .set =
               [](Arguments& a, const OptionValue& value) {
                 a.sampling.seed = value.whole_number(0, std::numeric_limits<std::uint32_t>::max());
               }},
    Option{
        .names = "--max-depth",
        .metavar = "N",
        .help = "maximum path length in segments, 1 to 65536: 1 shows emission only, 2 adds direct "
                "light",
        .default_value = "32",
        .samples = Samples::change,
        .set = [](Arguments& a,
                  const OptionValue& value) { a.path.max_depth = value.whole_number(1, 65536); }},
    Option{
        .names = "--backfaces",
        .metavar = "KIND",
        .help =
            "what happens to light paths that hit the back of a one-sided surface: pass (they go "
            "through, like camera rays) or occlude (they end, so one-sided walls block sunlight)",
        .default_value = "pass",
        .samples = Samples::change,
        .words = [] { return names_of(kBackfaces); },
        .set = [](Arguments& a,
                  const OptionValue& value) { a.path.backfaces = value.choice(kBackfaces); }},
    Option{.names = "--bsdf",
           .metavar = "MODEL",
           .help = "formulas for surfaces: conserving (keeps the energy of light that is scattered "
                   "several times) or spec (those of the glTF specification, for comparisons with "
                   "other renderers)",
           .default_value = "conserving",
           .samples = Samples::change,
           .words = [] { return names_of(kBsdfModels); },
           .set = [](Arguments& a,
                     const OptionValue& value) { a.path.bsdf = value.choice(kBsdfModels); }},
    Option{.names = "--guiding",
           .help =
               "let paths first learn where light arrives from and then prefer these directions, "
               "for light that is hard to find: through a gap, through glass",
           .samples = Samples::change,
           .excludes = "--shutter",
           .set = [](Arguments& a, const OptionValue&) { a.path.guiding = true; }},
};
static_assert(is_complete(kSamplingOptions));

constexpr std::array kCheckpointOptions{
    Option{.names = "--quality",
           .metavar = "NAME",
           .help = "quality of a path-traced picture: draft (--spp 16), good (--spp 256 "
                   "--target-error 0.03) or final (--spp 4096 --target-error 0.01); shards take "
                   "only the samples; --spp and --target-error override its values",
           .samples = Samples::change,
           .words = quality_names,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.sampling.quality = parse_quality(value); }},
    Option{
        .names = "--target-error",
        .metavar = "E",
        .help = "stop sampling tiles whose relative error is at most E, such as 0.02; --spp is "
                "the maximum",
        .default_value = "take all samples",
        .samples = Samples::change,
        .set = [](Arguments& a,
                  const OptionValue& value) { a.sampling.target_error = value.positive_number(); }},
    Option{.names = "--time-limit",
           .metavar = "S",
           .help =
               "start no further sampling pass once rendering has taken S seconds; the picture is "
               "made from the samples taken so far",
           .default_value = "none",
           .samples = Samples::keep,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.sampling.time_limit = value.seconds(); }},
    Option{
        .names = "--checkpoint",
        .metavar = "FILE",
        .help = "save the samples to FILE while rendering and at the end; if FILE exists, "
                "continue from it",
        .samples = Samples::keep,
        .completion = Completion::files,
        .set = [](Arguments& a, const OptionValue& value) { a.sampling.checkpoint = value.text; }},
    Option{.names = "--resume",
           .metavar = "FILE",
           .help = "continue from this checkpoint as well; may be repeated",
           .samples = Samples::keep,
           .completion = Completion::files,
           .is_repeatable = true,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.sampling.resume.emplace_back(value.text); }},
    Option{
        .names = "--shard",
        .metavar = "I/N",
        .help =
            "take only part I of N of the samples, save them to --checkpoint with the channels of "
            "--aov, and write no picture; microtrace merge makes the picture from all parts",
        .samples = Samples::keep,
        .needs = "--checkpoint",
        .excludes = "--output --sidecar --progressive --target-error",
        .set = [](Arguments& a,
                  const OptionValue& value) { a.sampling.shard = parse_shard(value); }},
    Option{.names = "--progressive",
           .help = "write the picture repeatedly while rendering",
           .samples = Samples::keep,
           .set = [](Arguments& a, const OptionValue&) { a.sampling.is_progressive = true; }},
    Option{.names = "--display-server",
           .metavar = "HOST:PORT",
           .help = "show the picture while rendering in the image viewer tev, which listens on "
                   "port 14158 of its machine",
           .samples = Samples::keep,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.display_server = parse_address(value); }},
    Option{.names = "--save-every",
           .metavar = "S",
           .help = "seconds between two saves of the checkpoint and of the progressive picture",
           .default_value = "60",
           .samples = Samples::keep,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.sampling.save_every = value.seconds(); }},
};
static_assert(is_complete(kCheckpointOptions));

}  // namespace

std::span<const Option> sampling_options() {
  return kSamplingOptions;
}

std::span<const Option> checkpoint_options() {
  return kCheckpointOptions;
}

}  // namespace microtrace::cli

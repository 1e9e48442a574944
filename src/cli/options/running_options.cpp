#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <array>
#include <cstdint>
#include <limits>

namespace microtrace::cli {
namespace {

constexpr std::array kStatistics{Choice<Statistics>{"text", Statistics::text},
                                 Choice<Statistics>{"json", Statistics::json}};
constexpr std::array kProgress{Choice<Progress>{"bar", Progress::bar},
                               Choice<Progress>{"json", Progress::json},
                               Choice<Progress>{"none", Progress::none}};

constexpr std::array kRunningOptions{
    Option{.names = "-t,-j,--threads",
           .metavar = "N",
           .help = "number of threads, 1 to 1024; the picture doesn't depend on it",
           .default_value = "one per available processor",
           .samples = Samples::keep,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.threads = value.whole_number(1, 1024); }},
    Option{.names = "--max-time",
           .metavar = "S",
           .help = "end the run after S seconds, in any stage, with exit code 6 and no picture; "
                   "meant for untrusted scenes",
           .default_value = "none",
           .samples = Samples::keep,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.max_time = value.positive_number(); }},
    Option{.names = "--end-with-parent",
           .metavar = "PID",
           .help = "end the run when its parent process ends, as after the signal TERM; at once if "
                   "the parent is not process PID",
           .implied_value = "0",
           .samples = Samples::keep,
           .set =
               [](Arguments& a, const OptionValue& value) {
                 a.parent = value.whole_number(0, std::numeric_limits<std::int32_t>::max());
               }},
    Option{.names = "--memory-limit",
           .metavar = "BYTES",
           .help =
               "maximum memory, in bytes or with K, M or G for KiB, MiB or GiB: an allocation that "
               "would exceed it ends the run with exit code 6",
           .default_value = "three quarters of the free memory",
           .samples = Samples::keep,
           .set = [](Arguments& a, const OptionValue& value) { a.memory_limit = value.bytes(); }},
    Option{.names = "--stats",
           .metavar = "KIND",
           .help = "report time, memory and ray counts on standard error as text or, with "
                   "--stats=json, as JSON",
           .implied_value = "text",
           .samples = Samples::keep,
           .words = [] { return names_of(kStatistics); },
           .set = [](Arguments& a,
                     const OptionValue& value) { a.statistics = value.choice(kStatistics); }},
    Option{.names = "--progress",
           .metavar = "KIND",
           .help = "how to show progress on standard error: bar (if it is a terminal), json (one "
                   "line per update) or none",
           .default_value = "bar",
           .samples = Samples::keep,
           .words = [] { return names_of(kProgress); },
           .set = [](Arguments& a,
                     const OptionValue& value) { a.progress = value.choice(kProgress); }},
    Option{.names = "--strict",
           .help = "treat warnings as errors: end with exit code 3 and write no picture",
           .samples = Samples::keep,
           .set = [](Arguments& a, const OptionValue&) { a.strict = true; }},
    Option{.names = "--validate",
           .help =
               "check the scene, print the result and render nothing; the exit code is 3 if the "
               "scene breaks a rule of its format",
           .samples = Samples::keep,
           .set = [](Arguments& a, const OptionValue&) { a.validate = true; }},
};
static_assert(is_complete(kRunningOptions));

constexpr std::array kReportOptions{
    Option{.names = "-v,--verbose",
           .help = "report input, render settings and output",
           .samples = Samples::keep,
           .excludes = "--quiet",
           .set = [](Arguments& a, const OptionValue&) { a.verbose = true; }},
    Option{.names = "--version",
           .help = "print the program's name and version",
           .samples = Samples::keep},
};
static_assert(is_complete(kReportOptions));

constexpr std::array kCommonOptions{
    Option{.names = "-q,--quiet",
           .help = "print no warnings, no progress bar and no line about the written files",
           .samples = Samples::keep,
           .set = [](Arguments& a, const OptionValue&) { a.quiet = true; }},
    Option{.names = "-h,--help", .help = "print this list", .samples = Samples::keep},
};
static_assert(is_complete(kCommonOptions));

constexpr std::array kMergeOptions{
    Option{.names = "CHECKPOINT",
           .metavar = "FILE",
           .help = "checkpoints of one picture, written by --checkpoint",
           .samples = Samples::keep,
           .completion = Completion::files,
           .is_required = true,
           .is_repeatable = true,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.checkpoints.emplace_back(value.text); }},
    Option{.names = "-o,--output",
           .metavar = "FILE",
           .help = "picture file; the extension selects the format",
           .samples = Samples::keep,
           .completion = Completion::files,
           .set = [](Arguments& a, const OptionValue& value) { a.output = value.text; }},
    Option{
        .names = "--checkpoint",
        .metavar = "FILE",
        .help = "save the samples of all checkpoints to FILE, which can be merged or continued",
        .samples = Samples::keep,
        .completion = Completion::files,
        .set = [](Arguments& a, const OptionValue& value) { a.sampling.checkpoint = value.text; }},
    Option{.names = "--frames",
           .metavar = "A:B",
           .help = "merge the checkpoints of each frame from A to B; all names contain a "
                   "placeholder for the frame number, as in part1_%04d",
           .default_value = "one picture",
           .samples = Samples::keep,
           .set = [](Arguments& a, const OptionValue& value) { a.frames = parse_frames(value); }},
    Option{.names = "--partial",
           .help = "merge even if samples are missing, which is otherwise an error",
           .samples = Samples::keep,
           .set = [](Arguments& a, const OptionValue&) { a.allows_missing_samples = true; }},
};
static_assert(is_complete(kMergeOptions));

}  // namespace

std::span<const Option> running_options() {
  return kRunningOptions;
}

std::span<const Option> report_options() {
  return kReportOptions;
}

std::span<const Option> common_options() {
  return kCommonOptions;
}

std::span<const Option> merge_options() {
  return kMergeOptions;
}

}  // namespace microtrace::cli

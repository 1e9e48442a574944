#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <array>
#include <limits>

namespace microtrace::cli {
namespace {

constexpr std::array kCompareOptions{
    Option{.names = "PICTURE",
           .metavar = "FILE",
           .help = "two pictures of equal size: .ppm, .png, .exr, .jpg, .webp, .tif, .hdr, ...",
           .samples = Samples::keep,
           .completion = Completion::files,
           .is_required = true,
           .is_repeatable = true,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.compare.pictures.emplace_back(value.text); }},
    Option{.names = "--threshold",
           .metavar = "X",
           .help = "greatest difference of two samples that is accepted; samples of 8 and 16 bits "
                   "range from 0 to 1",
           .default_value = "0",
           .samples = Samples::keep,
           .set =
               [](Arguments& a, const OptionValue& value) {
                 a.compare.threshold = value.number(0, std::numeric_limits<double>::max());
               }},
    Option{.names = "-o,--output",
           .metavar = "FILE",
           .help = "write a picture of the absolute differences; 8-bit formats show eight times "
                   "the difference",
           .samples = Samples::keep,
           .completion = Completion::files,
           .set = [](Arguments& a, const OptionValue& value) { a.output = value.text; }},
    Option{.names = "--json",
           .help = "print JSON instead of text",
           .samples = Samples::keep,
           .set = [](Arguments& a, const OptionValue&) { a.compare.is_json = true; }},
};
static_assert(is_complete(kCompareOptions));

}  // namespace

std::span<const Option> compare_options() {
  return kCompareOptions;
}

}  // namespace microtrace::cli

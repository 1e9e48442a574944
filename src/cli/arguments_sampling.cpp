#include "cli/arguments_sampling.hpp"

#include <cstdint>
#include <limits>
#include <string>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace microtrace::cli {

void add_sampling_options(CLI::App& app, Sampling& sampling) {
  app.add_option("--spp,--samples", sampling.samples,
                 "rays for each pixel, spread over it [with light 64, else 1, through its centre]")
      ->check(CLI::Range(1U, kMaxSamples))
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
      ->check(CLI::Range(0U, std::numeric_limits<std::uint32_t>::max()))
      ->type_name("N");
}

}  // namespace microtrace::cli

#include "cli/arguments_sampling.hpp"

#include <microtrace/render.hpp>

#include <cstdint>
#include <limits>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace microtrace::cli {

void add_sampling_options(CLI::App& app, Sampling& sampling) {
  app.add_option("--spp,--samples", sampling.samples,
                 "rays for each pixel, spread over it [1, through its centre]")
      ->check(CLI::Range(1U, kMaxSamples))
      ->type_name("N");
  app.add_option("--seed", sampling.seed,
                 "of all that is random: another number gives other noise [0]")
      ->check(CLI::Range(0U, std::numeric_limits<std::uint32_t>::max()))
      ->type_name("N");
}

}  // namespace microtrace::cli

#pragma once
/// Options for the samples that pixels are made of.

#include <microtrace/render.hpp>

#include <cstdint>

namespace CLI {
class App;
}

namespace microtrace::cli {

struct Sampling {
  std::uint32_t samples = 0;  ///< per pixel; 0: as settle() has it
  PixelFilter filter = PixelFilter::box;
  std::uint32_t seed = 0;
};

/// Adds the options, which are written to `sampling` when the app parses.
void add_sampling_options(CLI::App& app, Sampling& sampling);

}  // namespace microtrace::cli

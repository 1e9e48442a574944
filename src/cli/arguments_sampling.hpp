#pragma once
/// Options for the samples that pixels are made of.

#include <microtrace/render.hpp>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace microtrace::cli {

/// Part `index`, from 1, of so many.
struct Shard {
  std::uint32_t index = 1, count = 1;
};

struct Sampling {
  std::uint32_t samples = 0;  ///< per pixel; 0: as settle() has it
  PixelFilter filter = PixelFilter::box;
  std::uint32_t seed = 0;
  double target_error = 0;  ///< of tiles, at which they take no more samples; 0: none
  double time_limit = std::numeric_limits<double>::infinity();  ///< seconds
  std::optional<Shard> shard{};  ///< of the samples, that is taken alone; no picture is made then
  std::filesystem::path checkpoint{};           ///< or none
  std::vector<std::filesystem::path> resume{};  ///< checkpoints to go on from
  double save_every = 60;                       ///< seconds between two writings
  bool is_progressive = false;                  ///< writes the picture while it is made
  /// The options on which samples depend, as Checkpoint has them.
  std::string identity{};

  /// The shard's samples.
  [[nodiscard]] std::optional<SampleRange> part() const;
  /// Whether samples come from files, or go to some while they are taken.
  [[nodiscard]] bool keeps_samples() const {
    return !checkpoint.empty() || !resume.empty() || is_progressive;
  }
  [[nodiscard]] bool wants_passes() const {
    return keeps_samples() || target_error > 0 ||
           time_limit < std::numeric_limits<double>::infinity();
  }
};

/// Adds the options, which are written to `sampling` when the app parses.
void add_sampling_options(CLI::App& app, Sampling& sampling);

/// What is left to do when it has. Throws CLI::ParseError where options make no sense together.
void finish_sampling(const CLI::App& app, Sampling& sampling);

/// Throws Error (usage) where the options make no sense for a picture with that number of samples,
/// which are random where it has light.
void check_sampling(const Sampling& sampling, bool has_light);

}  // namespace microtrace::cli

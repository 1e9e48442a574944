#include "cli/options/applicable.hpp"

#include <microtrace/aov.hpp>

#include <array>
#include <limits>
#include <string>
#include <variant>

namespace microtrace::cli {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// An option that not all integrators can apply.
struct LimitedOption {
  std::string_view name;
  void (*omit)(Arguments&);
  /// Returns true if the option has an effect in path tracing. Null if `error` decides.
  bool (*needs_paths)(const Arguments&) = nullptr;
  std::string_view reason{};  ///< why it needs path tracing, as the end of a sentence
  /// Returns the error if the option can't be applied, else an empty text.
  std::string (*error)(const Arguments&) = nullptr;
  /// Returns those of the option's values that can't be applied; null if it has only one value.
  std::string (*values)(const Arguments&) = nullptr;
};

/// Returns the error about an option that needs path tracing; an empty text if it isn't given.
std::string path_error(const Arguments& a, bool is_given, std::string_view option,
                       std::string_view reason = "") {
  if (!is_given || a.is_path_traced()) return "";
  return std::string(option) + " needs path tracing" + std::string(reason) +
         "; use --integrator path";
}

/// Returns the error if the option can't be applied, else an empty text.
std::string error_of(const LimitedOption& option, const Arguments& a) {
  if (option.error != nullptr) return option.error(a);
  return path_error(a, option.needs_paths(a), option.name, option.reason);
}

std::string channel_error(const Arguments& a) {
  if (a.aovs.sampled.empty()) return "";
  return path_error(a, true, "--aov: " + std::string(name_of(a.aovs.sampled.front())));
}

std::string sampled_channels(const Arguments& a) {
  std::string names;
  for (const SampledAov channel : a.aovs.sampled) {
    if (!names.empty()) names += ',';
    names += name_of(channel);
  }
  return names;
}

std::string samples_error(const Arguments& a) {
  const auto* quantity = std::get_if<Aov>(&*a.integrator);
  if (quantity == nullptr || a.sampling.samples <= 1) return "";
  return "--spp: --integrator " + std::string(name_of(*quantity)) +
         " shows a quantity, which can't be averaged; omit --spp";
}

constexpr std::array kLimitedOptions{
    LimitedOption{.name = "--background",
                  .omit = [](Arguments& a) { a.environment.background.reset(); },
                  .error =
                      [](const Arguments& a) {
                        return path_error(a, a.environment.shows_environment(),
                                          "--background: env");
                      }},
    LimitedOption{.name = "--aov",
                  .omit = [](Arguments& a) { a.aovs.sampled.clear(); },
                  .error = channel_error,
                  .values = sampled_channels},
    LimitedOption{
        .name = "--aperture",
        .omit =
            [](Arguments& a) {
              a.camera.lens_radius.reset();
              a.camera.focus.reset();
            },
        .needs_paths = [](const Arguments& a) { return a.camera.lens_radius.value_or(0) > 0; },
        .reason = ", because other pictures have no depth of field"},
    LimitedOption{
        .name = "--max-depth",
        .omit = [](Arguments& a) { a.path.max_depth = PathOptions().max_depth; },
        .needs_paths =
            [](const Arguments& a) { return a.path.max_depth != PathOptions().max_depth; }},
    LimitedOption{
        .name = "--backfaces",
        .omit = [](Arguments& a) { a.path.backfaces = PathOptions().backfaces; },
        .needs_paths =
            [](const Arguments& a) { return a.path.backfaces != PathOptions().backfaces; }},
    LimitedOption{.name = "--ground",
                  .omit = [](Arguments& a) { a.path.ground.reset(); },
                  .needs_paths = [](const Arguments& a) { return a.path.ground.has_value(); },
                  .reason = ", which casts shadows"},
    LimitedOption{.name = "--guiding",
                  .omit = [](Arguments& a) { a.path.guiding = false; },
                  .needs_paths = [](const Arguments& a) { return a.path.guiding; }},
    LimitedOption{.name = "--bsdf",
                  .omit = [](Arguments& a) { a.path.bsdf = BsdfModel::conserving; },
                  .needs_paths = [](const Arguments& a) { return a.path.bsdf == BsdfModel::spec; }},
    LimitedOption{.name = "--denoise",
                  .omit = [](Arguments& a) { a.denoises = false; },
                  .needs_paths = [](const Arguments& a) { return a.denoises; },
                  .reason = ", because other pictures have no noise"},
    LimitedOption{.name = "--quality",
                  .omit = [](Arguments& a) { a.sampling.quality = nullptr; },
                  .needs_paths = [](const Arguments& a) { return a.sampling.quality != nullptr; }},
    LimitedOption{.name = "--target-error",
                  .omit = [](Arguments& a) { a.sampling.target_error = 0; },
                  .needs_paths = [](const Arguments& a) { return a.sampling.target_error > 0; }},
    LimitedOption{
        .name = "--time-limit",
        .omit = [](Arguments& a) { a.sampling.time_limit = kNoLimit; },
        .needs_paths = [](const Arguments& a) { return a.sampling.time_limit < kNoLimit; }},
    LimitedOption{.name = "--spp",
                  .omit = [](Arguments& a) { a.sampling.samples = 0; },
                  .error = samples_error},
};

}  // namespace

void check_applicable(const Arguments& arguments) {
  for (const LimitedOption& option : kLimitedOptions) {
    const std::string error = error_of(option, arguments);
    if (!error.empty()) refuse_usage(error);
  }
}

std::vector<std::string> omit_inapplicable(Arguments& arguments) {
  std::vector<std::string> omitted;
  for (const LimitedOption& option : kLimitedOptions) {
    if (error_of(option, arguments).empty()) continue;
    std::string& words = omitted.emplace_back(option.name);
    if (option.values != nullptr) words += ' ' + option.values(arguments);
    option.omit(arguments);
  }
  return omitted;
}

}  // namespace microtrace::cli

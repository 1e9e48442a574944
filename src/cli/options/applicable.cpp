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
  /// Returns the error if the option can't be applied, else an empty text.
  std::string (*error)(const Arguments&);
  void (*omit)(Arguments&);
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
                  .error =
                      [](const Arguments& a) {
                        return path_error(a, a.environment.shows_environment(),
                                          "--background: env");
                      },
                  .omit = [](Arguments& a) { a.environment.background.reset(); }},
    LimitedOption{.name = "--aov",
                  .error = channel_error,
                  .omit = [](Arguments& a) { a.aovs.sampled.clear(); },
                  .values = sampled_channels},
    LimitedOption{.name = "--aperture",
                  .error =
                      [](const Arguments& a) {
                        return path_error(a, a.camera.lens_radius.value_or(0) > 0, "--aperture",
                                          ", because other pictures have no depth of field");
                      },
                  .omit =
                      [](Arguments& a) {
                        a.camera.lens_radius.reset();
                        a.camera.focus.reset();
                      }},
    LimitedOption{.name = "--max-depth",
                  .error =
                      [](const Arguments& a) {
                        return path_error(a, a.path.max_depth != PathOptions().max_depth,
                                          "--max-depth");
                      },
                  .omit = [](Arguments& a) { a.path.max_depth = PathOptions().max_depth; }},
    LimitedOption{.name = "--backfaces",
                  .error =
                      [](const Arguments& a) {
                        return path_error(a, a.path.backfaces != PathOptions().backfaces,
                                          "--backfaces");
                      },
                  .omit = [](Arguments& a) { a.path.backfaces = PathOptions().backfaces; }},
    LimitedOption{.name = "--ground",
                  .error =
                      [](const Arguments& a) {
                        return path_error(a, a.path.ground.has_value(), "--ground",
                                          ", which casts shadows");
                      },
                  .omit = [](Arguments& a) { a.path.ground.reset(); }},
    LimitedOption{
        .name = "--guiding",
        .error = [](const Arguments& a) { return path_error(a, a.path.guiding, "--guiding"); },
        .omit = [](Arguments& a) { a.path.guiding = false; }},
    LimitedOption{.name = "--bsdf",
                  .error =
                      [](const Arguments& a) {
                        return path_error(a, a.path.bsdf == BsdfModel::spec, "--bsdf");
                      },
                  .omit = [](Arguments& a) { a.path.bsdf = BsdfModel::conserving; }},
    LimitedOption{.name = "--denoise",
                  .error =
                      [](const Arguments& a) {
                        return path_error(a, a.denoises, "--denoise",
                                          ", because other pictures have no noise");
                      },
                  .omit = [](Arguments& a) { a.denoises = false; }},
    LimitedOption{.name = "--quality",
                  .error =
                      [](const Arguments& a) {
                        return path_error(a, a.sampling.quality != nullptr, "--quality");
                      },
                  .omit = [](Arguments& a) { a.sampling.quality = nullptr; }},
    LimitedOption{.name = "--target-error",
                  .error =
                      [](const Arguments& a) {
                        return path_error(a, a.sampling.target_error > 0, "--target-error");
                      },
                  .omit = [](Arguments& a) { a.sampling.target_error = 0; }},
    LimitedOption{.name = "--time-limit",
                  .error =
                      [](const Arguments& a) {
                        return path_error(a, a.sampling.time_limit < kNoLimit, "--time-limit");
                      },
                  .omit = [](Arguments& a) { a.sampling.time_limit = kNoLimit; }},
    LimitedOption{.name = "--spp",
                  .error = samples_error,
                  .omit = [](Arguments& a) { a.sampling.samples = 0; }},
};

}  // namespace

void check_applicable(const Arguments& arguments) {
  for (const LimitedOption& option : kLimitedOptions) {
    const std::string error = option.error(arguments);
    if (!error.empty()) refuse_usage(error);
  }
}

std::vector<std::string> omit_inapplicable(Arguments& arguments) {
  std::vector<std::string> omitted;
  for (const LimitedOption& option : kLimitedOptions) {
    if (option.error(arguments).empty()) continue;
    std::string& words = omitted.emplace_back(option.name);
    if (option.values != nullptr) words += ' ' + option.values(arguments);
    option.omit(arguments);
  }
  return omitted;
}

}  // namespace microtrace::cli

#include "io/gltf/material/image_problems.hpp"

#include <algorithm>
#include <cstddef>

namespace microtrace::io::gltf {
namespace {

/// What becomes of the textures that have an image.
struct Outcome {
  bool some_white = false, some_others = false, some_all_damaged = false;
};

std::vector<Outcome> outcomes_of(std::span<const std::optional<ImageProblem>> problems,
                                 std::span<const ImageUse> uses, std::span<const Texture> textures,
                                 std::span<const std::vector<std::uint32_t>> choices) {
  std::vector<Outcome> outcomes(problems.size());
  const auto is_damaged = [&](std::uint32_t i) {
    return problems[i] && problems[i]->kind == ImageProblem::Kind::damaged_header;
  };
  for (std::size_t t = 0; t < textures.size(); ++t) {
    if (choices[t].empty()) continue;
    const bool all_damaged = std::ranges::all_of(choices[t], is_damaged);
    const std::uint32_t drawn = *textures[t].image;
    for (const std::uint32_t i : choices[t]) {
      outcomes[i].some_all_damaged |= all_damaged;
      if (uses[drawn].is_wanted())
        (problems[drawn] ? outcomes[i].some_white : outcomes[i].some_others) = true;
    }
  }
  return outcomes;
}

/// Says what is drawn instead of a wanted image that can't be read.
std::string remedy(const Outcome& outcome) {
  if (!outcome.some_others) return "its textures are white";
  return outcome.some_white ? "its textures without another image are white"
                            : "its textures use other images";
}

}  // namespace

void report_problems(Asset& asset, std::span<const std::optional<ImageProblem>> problems,
                     std::span<const ImageUse> uses, std::span<const Texture> textures,
                     std::span<const std::vector<std::uint32_t>> choices) {
  const std::vector<Outcome> outcomes = outcomes_of(problems, uses, textures, choices);
  for (std::size_t i = 0; i < problems.size(); ++i) {
    if (!problems[i]) continue;
    const auto& [kind, at, message, reason] = *problems[i];
    if (kind == ImageProblem::Kind::damaged_header && outcomes[i].some_all_damaged)
      asset.fail(at, "holds a damaged image: its header has no size");
    std::string text = message;
    text.append(uses[i].is_wanted() ? remedy(outcomes[i]) : "it is not used").append(reason);
    if (kind == ImageProblem::Kind::limitation)
      asset.warn(at, text);
    else
      asset.tolerate(at, text);
  }
}

}  // namespace microtrace::io::gltf

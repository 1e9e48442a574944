#pragma once
/// microtrace merge: one picture of the samples of several checkpoints.

#include "cli/arguments_light.hpp"

#include <microtrace/io.hpp>

#include <filesystem>
#include <optional>
#include <vector>

namespace microtrace::cli {

struct MergeArguments {
  std::vector<std::filesystem::path> files;
  std::filesystem::path output;
  Exposure exposure{};  ///< what is not given is as the first checkpoint says
  PpmEncoding ppm = PpmEncoding::binary;
  bool is_partial = false;  ///< a picture is wanted though samples are missing
  bool quiet = false;
};

/// Whether the command line begins with the word.
[[nodiscard]] bool is_merge(int argc, char** argv);

/// As parse_arguments().
struct ParsedMerge {
  MergeArguments arguments;
  std::optional<int> exit_code{};
};
[[nodiscard]] ParsedMerge parse_merge(int argc, char** argv);

/// Writes the picture. Throws Error, usage where samples are in none of the files and is_partial
/// does not allow it.
void merge_samples(const MergeArguments& arguments);

}  // namespace microtrace::cli

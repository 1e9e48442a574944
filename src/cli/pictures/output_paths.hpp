#pragma once
/// Checks that no output overwrites an input or another output.

#include "cli/pictures/sequence.hpp"

#include <microtrace/read_files.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace microtrace::cli {

/// A file to write, and the option that specifies it.
struct Output {
  const char* option;
  std::filesystem::path path;  ///< empty if no file is written
};

/// Throws Error (usage) if an output would overwrite a file that was read.
void check_no_input_is_overwritten(const ReadFiles& inputs, const std::vector<Output>& outputs);

/// Throws Error (usage) if two of the outputs are the same file.
void check_outputs_differ(const std::vector<Output>& outputs);

/// Makes the checks of the other two functions for all pictures, sidecars and checkpoints of a
/// sequence. Call it before checkpoints are read.
void check_paths(const ReadFiles& inputs, const Sequence& sequence);

}  // namespace microtrace::cli

#pragma once
/// Files to be written must be none of those that were read, and none of each other.

#include "cli/sequence.hpp"

#include <microtrace/read_files.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace microtrace::cli {

/// A file to be written, and the option that names it.
struct Output {
  const char* option;
  std::filesystem::path path;  ///< empty: none
};

/// Throws Error (usage) where one of the outputs would be written over a file that was read.
void refuse_to_write_over(const ReadFiles& inputs, const std::vector<Output>& outputs);

/// Throws Error (usage) where two of the outputs are one file.
void refuse_same_files(const std::vector<Output>& outputs);

/// Both, for all pictures and sidecars of a sequence.
void check_inputs_are_kept(const ReadFiles& inputs, const Sequence& sequence);

}  // namespace microtrace::cli

#pragma once
/// Frame numbers and the file names that contain them.

#include "cli/options/option_value.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace microtrace::cli {

inline constexpr std::uint32_t kMaxFrame = 999999;

/// Frames `first` to `last`, inclusive; frame k is at k / fps seconds.
struct FrameRange {
  std::uint32_t first = 0, last = 0;
  double fps = 24;

  [[nodiscard]] std::uint32_t count() const { return last - first + 1; }
  [[nodiscard]] double time(std::uint32_t frame) const { return frame / fps; }
};

/// Parses A:B, the frames A to B inclusive. This function and the next throw Error (usage).
[[nodiscard]] FrameRange parse_frames(const OptionValue& value);

/// Throws Error (usage) unless the pattern contains one placeholder for the frame number: %d, or a
/// form like %04d that adds leading zeros. %% stands for %. The pattern "-" is also accepted; it
/// writes all frames to standard output, one after another. `option` is the option whose value is
/// the pattern.
void check_pattern(const char* option, const std::string& pattern);

/// Returns the file name of one frame.
[[nodiscard]] std::filesystem::path frame_path(const std::string& pattern, std::uint32_t frame);

}  // namespace microtrace::cli

#pragma once
/// The JSON that the page receives. docs/internals.md lists the members.

#include "cli/view/picture_job.hpp"

#include <microtrace/error.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace microtrace::cli {

/// Describes a picture or an error that a LivePicture publishes.
struct PictureDescription {
  std::uint64_t request = 0, revision = 0;
  std::uint32_t samples = 0, requested_samples = 0;
  bool is_preview = false, is_done = false;
  double seconds = 0;  ///< since the drawing began
};

/// Returns an object in one line, of ASCII characters.
[[nodiscard]] std::string json_of(const PictureDescription& description);
/// Adds the part of the picture that is drawn, which --crop selects, and the camera.
[[nodiscard]] std::string json_of(const PictureDescription& description, const PictureJob& job);
/// Adds the member "sequence" to an object in JSON.
[[nodiscard]] std::string with_sequence(const std::string& object, std::uint64_t sequence);

[[nodiscard]] std::string error_json(const std::string& error);

struct SceneDescription {
  std::string name;
  std::vector<std::string> words;  ///< the program's options
  std::uint64_t revision = 0;
  std::size_t scenes = 1;  ///< number of scenes that the program shows
};

/// Describes the scene file: what can be selected, and what its warnings say.
[[nodiscard]] std::string scene_json(const SceneDescription& description, const ShownScene& shown);
/// Describes a scene that can't be loaded: the error, and what is known without the scene.
[[nodiscard]] std::string scene_json(const SceneDescription& description, const std::string& error);

}  // namespace microtrace::cli

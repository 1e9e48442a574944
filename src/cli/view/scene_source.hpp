#pragma once
/// The scene file of the page, and the poses of the scene that are prepared for rendering.

#include "cli/arguments.hpp"

#include <microtrace/environment.hpp>
#include <microtrace/error.hpp>
#include <microtrace/io.hpp>
#include <microtrace/memory.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/read_files.hpp>

#include <atomic>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace microtrace::cli {

/// A scene that is ready for rendering. Immutable.
struct ShownScene {
  PreparedScene prepared;
  SceneFormat format = SceneFormat::json;
  std::vector<Diagnostic> warnings{};
  SceneChoices choices{};
  DVec3 center{0};      ///< of the bounding box, world space
  double distance = 1;  ///< from the center to a camera that frames the scene
};

/// Sets the members center and distance.
[[nodiscard]] ShownScene with_extent(ShownScene scene);

/// May be used by any number of threads.
class SceneSource {
 public:
  /// Reads the scene file of the arguments when it is needed.
  /// `memory` must outlive this object.
  SceneSource(const Arguments& arguments, MemoryBudget& memory);
  /// Always returns the given scene, unless it is null.
  SceneSource(const Arguments& arguments, MemoryBudget& memory,
              std::shared_ptr<const ShownScene> scene);

  /// Returns the scene with the variant and at the time that the arguments select. Throws Error.
  [[nodiscard]] std::shared_ptr<const ShownScene> get(const LoadOptions& wanted);

  /// Returns the environment of --env, if given. Throws Error.
  [[nodiscard]] std::optional<Environment> environment(const EnvironmentOptions& options);

  /// Makes get() and environment() read their files again.
  void discard();
  /// The number of calls of discard() so far.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }

  /// The files that were read so far, with their states from before they were first read.
  [[nodiscard]] std::map<std::string, FileState> files() const;

  [[nodiscard]] const std::string& name() const { return path_; }
  [[nodiscard]] MemoryBudget& memory() { return memory_; }

 private:
  /// The numbers of scenes and environments that are kept for other views.
  static constexpr std::size_t kScenes = 2, kEnvironments = 2;

  struct Key {
    std::string variant, animation;
    std::optional<double> time;
    bool operator==(const Key&) const = default;
  };

  [[nodiscard]] std::shared_ptr<const ShownScene> load(const Key& key);
  /// Forgets what was read before the last call of discard(). The caller holds mutex_.
  void forget_stale();
  void note_files(const std::map<std::string, FileState>& states);

  MemoryBudget& memory_;
  LoadOptions options_;
  std::string path_;
  unsigned threads_;
  std::shared_ptr<const ShownScene> fixed_;
  std::atomic<std::uint64_t> revision_ = 0;

  mutable std::mutex mutex_;  // guards what follows
  std::uint64_t loaded_revision_ = 0;
  std::optional<SceneFile> file_;
  Key file_key_;  // its time is not used
  std::deque<std::pair<Key, std::shared_ptr<const ShownScene>>> scenes_;
  std::deque<std::pair<std::string, Environment>> environments_;

  mutable std::mutex files_mutex_;          // another one, because loading a scene takes long
  std::map<std::string, FileState> files_;  // guarded by files_mutex_
};

}  // namespace microtrace::cli

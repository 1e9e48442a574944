#include "cli/view/scene_source.hpp"

#include "base/system/processors.hpp"
#include "cli/options/option_value.hpp"
#include "cli/pictures/environment.hpp"

#include <microtrace/framing.hpp>

#include <algorithm>
#include <utility>

namespace microtrace::cli {

ShownScene with_extent(ShownScene shown) {
  const Scene& scene = shown.prepared.scene();
  Framing framing(View{}, scene.size);
  framing.add(scene);
  shown.center = framing.center() + framing.origin();
  shown.distance = glm::length(framing.camera().pose.position - framing.center());
  return shown;
}

SceneSource::SceneSource(const Arguments& arguments, MemoryBudget& memory)
    : memory_(memory),
      options_(arguments.load),
      path_(arguments.scene),
      threads_(thread_count(arguments.threads)),
      files_{{arguments.scene, state_of(arguments.scene)}} {
  options_.detail = SurfaceDetail::all;  // the page selects the integrator
  options_.memory = &memory_;
  options_.needs_regular_file = true;  // a pipe that replaces the file would block the page
}

SceneSource::SceneSource(const Arguments& arguments, MemoryBudget& memory,
                         std::shared_ptr<const ShownScene> scene)
    : SceneSource(arguments, memory) {
  fixed_ = std::move(scene);
  if (fixed_) files_.clear();
}

std::shared_ptr<const ShownScene> SceneSource::get(const LoadOptions& wanted) {
  const Key key{.variant = wanted.variant, .animation = wanted.animation, .time = wanted.time};
  if (fixed_) {
    if (key != Key{}) refuse_usage("--time and --variant need a scene file");
    return fixed_;
  }
  const std::scoped_lock lock(mutex_);
  forget_stale();
  const auto known = std::ranges::find(scenes_, key, [](const auto& entry) { return entry.first; });
  if (known != scenes_.end()) return known->second;
  std::shared_ptr<const ShownScene> scene = load(key);
  scenes_.emplace_front(key, scene);
  if (scenes_.size() > kScenes) scenes_.pop_back();
  return scene;
}

void SceneSource::forget_stale() {
  const std::uint64_t revision = revision_;
  if (revision == loaded_revision_) return;
  file_.reset();
  scenes_.clear();
  environments_.clear();
  loaded_revision_ = revision;
}

void SceneSource::note_files(const std::map<std::string, FileState>& states) {
  const std::scoped_lock lock(files_mutex_);
  files_.insert(states.begin(), states.end());
}

std::shared_ptr<const ShownScene> SceneSource::load(const Key& key) {
  const ReadFiles reading;
  try {
    if (!file_ || file_key_.variant != key.variant || file_key_.animation != key.animation) {
      LoadOptions options = options_;
      options.variant = key.variant;
      options.animation = key.animation;
      file_.emplace(path_, options);
      file_key_ = key;
    }
    LoadedScene loaded = file_->at(key.time);
    note_files(reading.states());
    PrepareOptions prepare{.threads = threads_, .memory = &memory_};
    // Refitting the tree of the previous time is faster than building another one.
    if (!scenes_.empty()) prepare.tables = scenes_.front().second->prepared.tables();
    return std::make_shared<const ShownScene>(
        with_extent({.prepared = PreparedScene(std::move(loaded.scene), prepare),
                     .format = loaded.format,
                     .warnings = std::move(loaded.warnings),
                     .choices = file_->choices()}));
  } catch (...) {
    note_files(reading.states());
    file_.reset();
    throw;
  }
}

std::optional<Environment> SceneSource::environment(const EnvironmentOptions& options) {
  std::vector<Diagnostic> warnings;  // about repaired values in the map
  const auto* file =
      options.source ? std::get_if<std::filesystem::path>(&*options.source) : nullptr;
  if (file == nullptr) return load_environment(options, warnings, memory_);
  const std::scoped_lock lock(mutex_);
  forget_stale();
  const std::string name = file->string();
  const auto known =
      std::ranges::find(environments_, name, [](const auto& entry) { return entry.first; });
  if (known != environments_.end()) return known->second;
  note_files({{name, state_of(name)}});
  std::optional<Environment> environment = load_environment(options, warnings, memory_);
  environments_.emplace_front(name, *environment);
  if (environments_.size() > kEnvironments) environments_.pop_back();
  return environment;
}

void SceneSource::discard() {
  ++revision_;
}

std::map<std::string, FileState> SceneSource::files() const {
  const std::scoped_lock lock(files_mutex_);
  return files_;
}

}  // namespace microtrace::cli

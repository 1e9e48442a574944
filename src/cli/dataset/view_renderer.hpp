#pragma once
/// Renders the views of a data set into files.

#include "cli/arguments.hpp"
#include "cli/report/warnings.hpp"

#include <microtrace/annotations.hpp>
#include <microtrace/dataset.hpp>
#include <microtrace/denoise.hpp>
#include <microtrace/digest.hpp>
#include <microtrace/environment.hpp>
#include <microtrace/io.hpp>
#include <microtrace/prepared_scene.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace microtrace::cli {

/// Keeps what consecutive views share: the scene file of a variant, the environment, the prepared
/// scene of a pose.
class ViewRenderer {
 public:
  /// Reads the scene file and applies the defaults of its format to `arguments`, which must outlive
  /// this object. Throws Error.
  ViewRenderer(Arguments& arguments, Warnings& warnings);

  /// Loads the scene of a view, without preparing it. Throws Error.
  void load(const DatasetView& view);

  /// The name of the pictures' denoiser; empty if there is none.
  [[nodiscard]] std::string denoiser() const { return denoiser_ ? denoiser_->name() : ""; }

  /// The loaded scene.
  [[nodiscard]] const Scene& scene() const { return *scene_; }

  /// Throws Error (usage) if the loaded scene lacks the camera that view number `index` names, if
  /// the options don't fit the camera, or if a requested format can't describe it.
  void check_camera(const DatasetView& view, std::uint32_t index) const;
  /// Throws Error if the scene lacks the variant, or the file of the environment can't be opened.
  void check_look(const DatasetView& view, std::uint32_t index) const;

  /// Renders a view into files in `folder`, whose subfolders are created. Returns their names,
  /// relative to the folder. Throws Error.
  std::vector<std::string> render(const DatasetView& view, std::uint32_t index,
                                  const std::filesystem::path& folder);

 private:
  /// Returns the options that select the camera of a view that has no camera of its own.
  [[nodiscard]] CameraOptions camera_options(const DatasetView& view, std::uint32_t index) const;
  [[nodiscard]] Camera camera_of(const DatasetView& view, std::uint32_t index, ImageSize size);
  /// Returns the channels from which the annotations are made.
  [[nodiscard]] std::vector<Aov> annotation_channels() const;
  void prepare(const DatasetView& view);
  /// Renders the prepared scene.
  [[nodiscard]] Film draw(const Camera& camera, ImageSize size, const std::vector<Aov>& aovs);
  void load_environment(const DatasetView& view, std::vector<Diagnostic>& warnings);
  /// Throws Error (usage) if BOP is written and the loaded scene has other objects than the first.
  void check_objects();
  std::string save_picture(Film& film, const std::string& name,
                           const std::filesystem::path& folder) const;
  /// Saves the annotations of a rendered view and the pictures that belong to them. Adds the names
  /// of the files to `names`.
  void save_annotations(const DatasetView& view, const AnnotatedPicture& picture, Film& film,
                        const std::filesystem::path& folder, std::vector<std::string>& names);

  void save_pictures(const std::string& stem, Film& film, const std::filesystem::path& folder,
                     std::vector<std::string>& names) const;

  Arguments& arguments_;
  Warnings& warnings_;
  MemoryBudget memory_;
  std::string variant_;                   ///< of file_
  std::optional<std::uint64_t> objects_;  ///< digest of the objects, for check_objects()
  std::optional<SceneFile> file_;
  /// The result of frame_all(), once a view has needed it.
  std::optional<std::optional<PerspectiveCamera>> framing_;
  std::optional<DatasetView> loaded_;  ///< the view whose scene is loaded
  std::string environment_source_;     ///< of environment_
  std::optional<Environment> environment_;
  std::shared_ptr<const Scene> scene_;
  std::optional<PreparedScene> prepared_;  ///< of scene_
  std::shared_ptr<const SharedTables> tables_;
  std::unique_ptr<Integrator> integrator_;
  std::optional<Denoiser> denoiser_;
  bool has_warned_ = false;  ///< about counts of a rendering
};

}  // namespace microtrace::cli

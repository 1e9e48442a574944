#pragma once
/// The commands `microtrace dataset` and `microtrace verify`.

#include "cli/arguments.hpp"
#include "cli/dataset/view_renderer.hpp"
#include "cli/report/warnings.hpp"

#include <microtrace/dataset.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace microtrace::cli {

/// The views of a data set, which several processes may render.
class Dataset {
 public:
  /// Finds the file with this name, such as a copy of it.
  using Locate = std::function<std::string(const std::string& name)>;

  /// Reads the list of views and the scene of the first view. If `warnings` is not null, appends
  /// warnings to it instead of printing them. `locate`, if given, finds the files that the list
  /// names. Throws Error.
  explicit Dataset(const Arguments& arguments, std::vector<Diagnostic>* warnings = nullptr,
                   const Locate& locate = {});
  Dataset(const Dataset&) = delete;
  Dataset& operator=(const Dataset&) = delete;

  [[nodiscard]] const DatasetIdentity& identity() const { return identity_; }
  /// See rendering_order().
  [[nodiscard]] std::vector<std::uint32_t> order() const;

  /// Creates the folder or checks that it has this data set. Throws Error.
  [[nodiscard]] DatasetFolder create(const std::filesystem::path& path) const;
  /// Reads the files of all views. Throws Error.
  void read_all();
  /// Renders a view into the folder and writes its record. Returns the names of the view's files.
  /// Throws Error.
  std::vector<std::string> render(DatasetFolder& folder, std::uint32_t view);
  /// Writes the files about all views, which must be finished. Returns their names. Throws Error.
  std::vector<std::string> finish(const DatasetFolder& folder);

 private:
  Arguments arguments_;
  std::vector<DatasetView> views_;
  Warnings warnings_;
  std::optional<ViewRenderer> renderer_;
  DatasetIdentity identity_;
};

/// Renders the views of a data set that are missing. Throws Error.
void write_dataset(const Arguments& arguments);

/// Checks the files of a data set and renders some views again. Throws Error (io) for the first
/// file that is damaged or differs.
void verify_dataset(const Arguments& arguments);

}  // namespace microtrace::cli

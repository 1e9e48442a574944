#pragma once
/// The views of a data set, and the order in which they are rendered.

#include "cli/arguments.hpp"

#include <microtrace/dataset.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace microtrace::cli {

/// The views that the options name: those of --views, at each of the --frames if both are given.
/// Throws Error.
[[nodiscard]] std::vector<DatasetView> views_of(const Arguments& arguments);

/// The size of a view's picture: its own, that of the options, that of its camera's calibration
/// images, or that of the scene.
[[nodiscard]] ImageSize size_of(const Arguments& arguments, const DatasetView& view,
                                const Scene& scene);

/// The name of a view's files without extension.
[[nodiscard]] std::string stem_of(const Arguments& arguments, const DatasetView& view,
                                  std::uint32_t index);

/// The name of the file with a view's annotations for COCO or BOP, until they are joined.
[[nodiscard]] std::string annotations_name(const Arguments& arguments, const DatasetView& view,
                                           std::uint32_t index, DatasetFormat format);

/// Returns true for the names of annotations_name().
[[nodiscard]] bool is_annotations(const std::string& name);

/// The name of the picture that the data set has of a view, for COCO; empty if it has none.
[[nodiscard]] std::string picture_name(const Arguments& arguments, const DatasetView& view,
                                       std::uint32_t index);

/// The name of the color picture of BOP.
[[nodiscard]] std::string bop_picture_name(std::uint32_t index);

/// Returns true if the data set has files of this format.
[[nodiscard]] bool writes(const Arguments& arguments, DatasetFormat format);

/// The folder of the views in BOP's format.
inline constexpr const char* kBopScene = "bop/train/000000/";

/// The indices of the shard's views, ordered so that views with the same variant, time and
/// environment follow each other: such views share one preparation.
[[nodiscard]] std::vector<std::uint32_t> rendering_order(const std::vector<DatasetView>& views,
                                                         const std::optional<Shard>& shard);

/// True if the views can share a prepared scene.
[[nodiscard]] bool share_scene(const DatasetView& a, const DatasetView& b);

}  // namespace microtrace::cli

#pragma once
/// Lists of views as arrays of NumPy.

#include <microtrace/dataset.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::dataset {

/// True if these are the first bytes of a .npz file.
[[nodiscard]] bool is_npz(std::string_view bytes);

/// Reads the views in a .npz file; docs/datasets.md defines the arrays. `image` is the size of the
/// calibration images if there is no array of sizes. Throws Error.
[[nodiscard]] std::vector<DatasetView> read_npz_views(std::string_view bytes,
                                                      const std::string& file,
                                                      const std::optional<ImageSize>& image);

}  // namespace microtrace::dataset

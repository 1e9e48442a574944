#pragma once
/// Formats the comparison as a table and as JSON.

#include "vs_embree_compare.hpp"

#include <span>
#include <string>

namespace microtrace::bench {

/// Returns the table's lines for one scene. Ratios above 1 mean that microtrace is faster.
[[nodiscard]] std::string table_lines(const SceneRows& rows);
[[nodiscard]] std::string table_head();

/// Returns a JSON array with one object for each build and each kind of rays.
[[nodiscard]] std::string json(std::span<const SceneRows> scenes);

}  // namespace microtrace::bench

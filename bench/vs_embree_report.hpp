#pragma once
/// The comparison for people and for programs.

#include "vs_embree_compare.hpp"

#include <span>
#include <string>

namespace microtrace::bench {

/// The lines of one scene under table_head(). Times over 1: microtrace is ahead.
[[nodiscard]] std::string table_lines(const SceneRows& rows);
[[nodiscard]] std::string table_head();

/// A JSON array with an object for each build and each kind of rays.
[[nodiscard]] std::string json(std::span<const SceneRows> scenes);

}  // namespace microtrace::bench

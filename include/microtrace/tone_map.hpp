#pragma once
/// Tone mapping operators.

#include <microtrace/export.hpp>

#include <array>
#include <optional>
#include <string_view>

namespace microtrace {

/// From linear Rec. 709 to linear Rec. 709 in [0, 1], before the encoding.
///
/// To add one: a value here and in kToneMaps, its name and its function in src/scene/tone_map.cpp,
/// its help text in src/cli/options/light_options.cpp, a line in docs/outputs.md and
/// docs/command-line.md, reference values in tests/unit/tone_map_test.cpp.
enum class ToneMap {
  none,                 ///< clamps to 1
  khronos_pbr_neutral,  ///< the Khronos PBR neutral tone mapper: keeps colors up to 0.8, minus 0.04
                        ///< for the reflection at the surface
  aces,  ///< S. Hill's fit of the ACES RRT and ODT, applied to colors / 0.6, as in three.js
  agx,   ///< T. Sobotka's AgX with Blender's base contrast, as in three.js
};

inline constexpr std::array kToneMaps = {ToneMap::none, ToneMap::khronos_pbr_neutral, ToneMap::aces,
                                         ToneMap::agx};

/// The name on the command line: "khronos-pbr-neutral".
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(ToneMap map);
[[nodiscard]] MICROTRACE_EXPORT std::optional<ToneMap> tone_map_named(std::string_view name);

}  // namespace microtrace

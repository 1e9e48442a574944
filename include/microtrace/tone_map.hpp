#pragma once
/// Tone maps for light brighter than a screen.

#include <microtrace/export.hpp>

#include <array>
#include <optional>
#include <string_view>

namespace microtrace {

/// From linear Rec. 709 to linear Rec. 709 in [0, 1], before the encoding.
///
/// To add one: its name in kToneMaps, its function in src/scene/tone_map.cpp.
enum class ToneMap {
  none,                 ///< clamps to 1
  khronos_pbr_neutral,  ///< the Khronos PBR neutral tone mapper: keeps colours up to 0.8 as they
                        ///< are, but for 0.04 less, which makes up for the reflection at a surface
  aces,  ///< S. Hill's fit of the ACES RRT and ODT, applied to colors / 0.6, as in three.js
  agx,   ///< T. Sobotka's AgX with Blender's base contrast, as in three.js
};

inline constexpr std::array kToneMaps = {ToneMap::none, ToneMap::khronos_pbr_neutral, ToneMap::aces,
                                         ToneMap::agx};

/// The name on the command line: "khronos-pbr-neutral".
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(ToneMap map);
[[nodiscard]] MICROTRACE_EXPORT std::optional<ToneMap> tone_map_named(std::string_view name);

}  // namespace microtrace

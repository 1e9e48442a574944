#pragma once
/// Tone mapping operators.

#include <microtrace/export.hpp>

#include <array>
#include <optional>
#include <string_view>

namespace microtrace {

/// Maps linear Rec. 709 colors to linear Rec. 709 colors in [0, 1], before the sRGB encoding.
///
/// To add a tone map, add a value here and in kToneMaps, its name and its function in
/// src/scene/tone_map.cpp, its help text in src/cli/options/light_options.cpp, a line in
/// docs/outputs.md and docs/command-line.md, and reference values in
/// tests/unit/math/tone_map_test.cpp.
enum class ToneMap {
  none,                 ///< clamps components to 1
  khronos_pbr_neutral,  ///< the Khronos PBR neutral tone mapper: colors up to 0.8 change only by an
                        ///< offset of at most 0.04, which removes the reflection of dielectrics at
                        ///< normal incidence
  aces,  ///< S. Hill's fit of the ACES RRT and ODT, applied to colors / 0.6, as in three.js
  agx,   ///< T. Sobotka's AgX with Blender's base contrast, as in three.js
};

inline constexpr std::array kToneMaps = {ToneMap::none, ToneMap::khronos_pbr_neutral, ToneMap::aces,
                                         ToneMap::agx};

/// Returns the name on the command line, such as "khronos-pbr-neutral".
[[nodiscard]] MICROTRACE_EXPORT std::string_view name_of(ToneMap map);
[[nodiscard]] MICROTRACE_EXPORT std::optional<ToneMap> tone_map_named(std::string_view name);

}  // namespace microtrace

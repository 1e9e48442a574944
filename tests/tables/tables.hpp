#pragma once
/// Generates the headers of tables in src/render/bsdf from their definitions.

#include <array>
#include <string>
#include <string_view>

namespace microtrace::tables {

[[nodiscard]] std::string ggx_albedo_table();
[[nodiscard]] std::string sheen_table();
[[nodiscard]] std::string coating_table();
[[nodiscard]] std::string coating_schlick_table();
[[nodiscard]] std::string refraction_loss_table();
[[nodiscard]] std::string refraction_loss_within_table();
[[nodiscard]] std::string refraction_slopes_table();
[[nodiscard]] std::string refraction_slopes_within_table();
[[nodiscard]] std::string anisotropic_loss_table();
[[nodiscard]] std::string anisotropic_schlick_table();

struct Header {
  std::string_view name;
  std::string (*text)();
};

inline constexpr std::array kHeaders{
    Header{"ggx_albedo_table.hpp", ggx_albedo_table},
    Header{"sheen_table.hpp", sheen_table},
    Header{"coating_table.hpp", coating_table},
    Header{"coating_schlick_table.hpp", coating_schlick_table},
    Header{"refraction_loss_table.hpp", refraction_loss_table},
    Header{"refraction_loss_within_table.hpp", refraction_loss_within_table},
    Header{"refraction_slopes_table.hpp", refraction_slopes_table},
    Header{"refraction_slopes_within_table.hpp", refraction_slopes_within_table},
    Header{"anisotropic_loss_table.hpp", anisotropic_loss_table},
    Header{"anisotropic_schlick_table.hpp", anisotropic_schlick_table},
};

}  // namespace microtrace::tables

#pragma once
#include <microtrace/math.hpp>

namespace microtrace::bsdf {

/// Layers above a surface. The defaults mean no layer.
struct Layers {
  enum class Side {
    both,   ///< on both sides of a thin wall
    above,  ///< on the side of wo
    below,
  };

  Vec3 sheen{0};              ///< color, linear Rec. 709, each in [0, 1] (KHR_materials_sheen)
  float sheen_roughness = 0;  ///< in [0, 1]
  float coat = 0, coat_roughness = 0;  ///< each in [0, 1] (KHR_materials_clearcoat)
  Vec3 coat_normal{0, 0, 1};           ///< unit length, on the side of wo
  Side side = Side::both;
};

}  // namespace microtrace::bsdf

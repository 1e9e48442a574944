#pragma once
#include <microtrace/math.hpp>

namespace microtrace::bsdf {

/// What lies over a surface. The defaults are nothing.
struct Layers {
  enum class Side {
    both,   ///< of a thin wall
    above,  ///< where wo is
    below,
  };

  Vec3 sheen{0};              ///< colour, linear Rec. 709, each in [0, 1] (KHR_materials_sheen)
  float sheen_roughness = 0;  ///< in [0, 1]
  float coat = 0, coat_roughness = 0;  ///< each in [0, 1] (KHR_materials_clearcoat)
  Vec3 coat_normal{0, 0, 1};           ///< unit length, above which wo is
  Side side = Side::both;
};

}  // namespace microtrace::bsdf

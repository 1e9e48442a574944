#include "scene/lens/lens.hpp"

namespace microtrace {

Lens::Lens(const Distortion& distortion)
    : lens_(std::holds_alternative<FisheyeDistortion>(distortion)
                ? decltype(lens_)(FisheyeLens(std::get<FisheyeDistortion>(distortion)))
                : RationalLens(std::get<RationalDistortion>(distortion))) {}

}  // namespace microtrace

#include "render/prepared/hidden_backs.hpp"

#include "base/bit_set.hpp"
#include "base/memory_account.hpp"

#include <variant>

namespace microtrace {

HiddenBacks::HiddenBacks(const Scene& scene, const Primitives& primitives) {
  PrimitiveId first = 0;
  for (const Object& object : scene.objects) {
    const PrimitiveId last = first + static_cast<PrimitiveId>(primitive_count(object.shape));
    if (std::holds_alternative<Mesh>(object.shape) && !material_of(scene, object).double_sided) {
      if (bits_.empty()) {
        take_memory(primitives.count() / 8, "the one-sided surfaces of the scene");
        bits_.resize(bit_set_size(primitives.count()));
      }
      insert(bits_.data(), first, last);
    }
    first = last;
  }
}

}  // namespace microtrace

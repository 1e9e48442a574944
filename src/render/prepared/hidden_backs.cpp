#include "render/prepared/hidden_backs.hpp"

#include "base/bit_set.hpp"
#include "base/memory_account.hpp"

#include <cstddef>
#include <variant>

namespace microtrace {

HiddenBacks::HiddenBacks(const Scene& scene, const Primitives& primitives) {
  std::size_t run = 0;
  for (const ObjectRun& objects : scene.objects.runs()) {
    const PrimitiveId first = primitives.first_id_of_run(run),
                      last = primitives.first_id_of_run(++run);
    const Object& object = *objects.first;
    if (!std::holds_alternative<Mesh>(object.shape) || material_of(scene, object).double_sided)
      continue;
    if (bits_.empty()) {
      take_memory(primitives.count() / 8, "the one-sided surfaces of the scene");
      bits_.resize(bit_set_size(primitives.count()));
    }
    insert(bits_.data(), first, last);
  }
}

}  // namespace microtrace

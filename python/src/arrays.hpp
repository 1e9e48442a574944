#pragma once
/// Shares the arrays of meshes between scenes in C++ and NumPy.

#include "common.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

namespace microtrace::python {

/// Returns the owner of the exported memory that begins at `data`, if the owner still exists. Null
/// for other memory.
std::shared_ptr<const void> owner_of(const void* data);
/// Makes owner_of(data) return the owner.
void remember_owner(const void* data, const std::shared_ptr<const void>& owner);

/// Returns a read-only NumPy array that shares the values.
template <class T>
nb::object rows_of(const Array<T>& values) {
  using Number = typename Array<T>::Number;
  auto shared = std::make_shared<const Array<T>>(values);
  const T* data = shared->data();
  if (!values.empty()) remember_owner(data, shared);
  const nb::capsule keeper(new std::shared_ptr<const void>(shared), [](void* p) noexcept {
    delete static_cast<std::shared_ptr<const void>*>(p);
  });
  return nb::cast(nb::ndarray<nb::numpy, const Number>(
      data, {shared->size(), sizeof(T) / sizeof(Number)}, keeper));
}

/// Does the same for an array that may be absent: returns None if there are no values.
template <class T>
nb::object to_python(const Array<T>& values) {
  return values.empty() ? nb::none() : rows_of(values);
}

/// Converts rows of numbers of type Source. Copies the values, because Python code may change them
/// at any time. Shares them only if to_python() made the array.
template <class T, class Source>
Array<T> copied(const AnyArray& rows) {
  constexpr std::size_t width = sizeof(T) / sizeof(typename Array<T>::Number);
  const auto* data = static_cast<const Source*>(rows.data());
  if (std::shared_ptr<const void> owner = owner_of(data);
      owner != nullptr && rows.stride(1) == 1 && sizeof(Source) * width == sizeof(T))
    return Array<T>::strided(data, rows.shape(0), rows.stride(0) * sizeof(Source), owner);
  std::vector<std::array<Source, width>> values(rows.shape(0));
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t k = 0; k < width; ++k)
      values[i][k] = data[static_cast<std::int64_t>(i) * rows.stride(0) +
                          static_cast<std::int64_t>(k) * rows.stride(1)];
  Array<T> result = Array<T>::strided(values.empty() ? nullptr : values[0].data(), values.size());
  static_cast<void>(result.edit());  // makes the array own its values
  return result;
}

/// Converts rows to an array. Throws Error for indices that don't fit into 32 bits.
template <class T>
Array<T> to_array(const AnyArray& rows) {
  if constexpr (std::is_floating_point_v<typename Array<T>::Number>) {
    if (rows.dtype() == nb::dtype<float>()) return copied<T, float>(rows);
    return copied<T, double>(rows);
  } else {
    if (rows.dtype() == nb::dtype<std::uint32_t>()) return copied<T, std::uint32_t>(rows);
    if (rows.dtype() == nb::dtype<std::int32_t>()) return copied<T, std::int32_t>(rows);
    if (rows.dtype() == nb::dtype<std::uint64_t>()) return copied<T, std::uint64_t>(rows);
    return copied<T, std::int64_t>(rows);
  }
}

}  // namespace microtrace::python

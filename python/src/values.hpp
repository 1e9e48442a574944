#pragma once
/// Converts the values of attributes. Errors name the attribute and the values that it may have.

#include "common.hpp"

#include <array>
#include <cstdint>
#include <nanobind/stl/array.h>
#include <string>
#include <type_traits>

namespace microtrace::python {

/// Describes the values of Python that cast<T>() converts.
template <class T>
constexpr const char* kWords = nullptr;
template <>
constexpr const char* kWords<std::string> = "a str";
template <>
constexpr const char* kWords<bool> = "True or False";
template <>
constexpr const char* kWords<float> = "a number";
template <>
constexpr const char* kWords<double> = "a number";
template <>
constexpr const char* kWords<std::uint32_t> = "an integer that is not negative";
template <>
constexpr const char* kWords<std::array<std::uint32_t, 2>> = "a width and a height";
template <>
constexpr const char* kWords<std::array<std::array<double, 3>, 2>> = "2 rows of 3 numbers";
template <>
constexpr const char* kWords<std::array<double, 10>> = "10 numbers";

/// Throws TypeError for the value of an attribute that must be what `wanted` says.
[[noreturn]] inline void refuse(const char* attribute, const std::string& wanted,
                                const nb::handle& value) {
  throw nb::type_error(
      (std::string(attribute) + " must be " + wanted + ", not " + nb::repr(value).c_str()).c_str());
}

/// Converts the value of an attribute to T.
template <class T>
T cast(const nb::handle& value, const char* attribute) {
  T result{};
  if (nb::try_cast(value, result)) return result;
  if constexpr (std::is_same_v<T, bool>) {
    // NumPy's truth values are not those of Python.
    if (nb::isinstance(value, nb::module_::import_("numpy").attr("bool_")))
      return nb::cast<bool>(nb::bool_(nb::borrow(value)));
  }
  if (std::is_same_v<T, std::string> && nb::isinstance<nb::str>(value))
    refuse(attribute, "a str without surrogates", value);
  refuse(attribute, kWords<T>, value);
}

/// Returns the items of an attribute's value.
inline nb::list list_of(const nb::handle& value, const char* attribute, const std::string& wanted) {
  PyObject* const items = PySequence_List(value.ptr());
  if (items != nullptr) return nb::steal<nb::list>(items);
  if (!PyErr_ExceptionMatches(PyExc_TypeError)) nb::raise_python_error();
  PyErr_Clear();
  refuse(attribute, wanted, value);
}

}  // namespace microtrace::python

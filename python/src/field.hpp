#pragma once
/// How fields.hpp lists the attributes of Python's dataclasses.

#include <tuple>
#include <type_traits>

namespace microtrace::python {

/// An attribute of a Python object and the member of T that holds its value. The library's errors
/// name the member, by `member_name`.
template <class T, class Member>
struct Field {
  const char* name;
  Member T::*member;
  const char* member_name = name;
};
template <class T, class Member>
Field(const char*, Member T::*) -> Field<T, Member>;
template <class T, class Member>
Field(const char*, Member T::*, const char*) -> Field<T, Member>;

/// Specialized for each struct, with the module kModule and the name kName of the Python class, and
/// the list kFields.
template <class T>
struct Class;

/// Calls f(name, member) for all fields of a struct.
template <class T, class F>
void for_each_field(T& value, const F& f) {
  std::apply([&](const auto&... field) { (f(field.name, value.*field.member), ...); },
             Class<std::remove_const_t<T>>::kFields);
}

}  // namespace microtrace::python

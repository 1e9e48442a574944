#pragma once
/// Short lists for members of which a scene may have millions.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <new>
#include <stdexcept>
#include <utility>

namespace microtrace {

/// A vector of the size of a pointer, for lists that are mostly empty. Has the main functions of
/// std::vector and is as thread-safe. Adding an element moves all others.
template <class T>
class ShortVector {
 public:
  using value_type = T;
  using size_type = std::size_t;
  using difference_type = std::ptrdiff_t;
  using reference = T&;
  using const_reference = const T&;
  using iterator = T*;
  using const_iterator = const T*;

  ShortVector() = default;
  ShortVector(std::initializer_list<T> values)
      : ShortVector(values.size(), [&](std::size_t i) -> const T& { return values.begin()[i]; }) {}
  ShortVector(const ShortVector& other)
      : ShortVector(other.size(), [&](std::size_t i) -> const T& { return other[i]; }) {}
  ShortVector(ShortVector&& other) noexcept : list_(std::exchange(other.list_, nullptr)) {}
  ShortVector& operator=(const ShortVector& other) {  // NOLINT(bugprone-unhandled-self-assignment)
    *this = ShortVector(other);
    return *this;
  }
  ShortVector& operator=(ShortVector&& other) noexcept {
    std::swap(list_, other.list_);
    return *this;
  }
  ShortVector& operator=(std::initializer_list<T> values) {
    *this = ShortVector(values);
    return *this;
  }
  ~ShortVector() {
    for (T& value : *this) value.~T();
    ::operator delete(list_);
  }

  [[nodiscard]] std::size_t size() const noexcept { return list_ != nullptr ? list_->size : 0; }
  [[nodiscard]] bool empty() const noexcept { return size() == 0; }
  [[nodiscard]] T* begin() noexcept { return first(); }
  [[nodiscard]] T* end() noexcept { return begin() + size(); }
  [[nodiscard]] const T* begin() const noexcept { return first(); }
  [[nodiscard]] const T* end() const noexcept { return begin() + size(); }
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return begin()[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return begin()[i]; }
  [[nodiscard]] T& front() noexcept { return *begin(); }
  [[nodiscard]] const T& front() const noexcept { return *begin(); }
  [[nodiscard]] T& back() noexcept { return end()[-1]; }
  [[nodiscard]] const T& back() const noexcept { return end()[-1]; }
  /// Throws std::out_of_range.
  [[nodiscard]] T& at(std::size_t i) { return begin()[checked(i)]; }
  [[nodiscard]] const T& at(std::size_t i) const { return begin()[checked(i)]; }

  void resize(std::size_t size) {
    T* const old = begin();
    const std::size_t kept = this->size();
    *this = ShortVector(size, [&](std::size_t i) { return i < kept ? std::move(old[i]) : T(); });
  }
  void push_back(T value) {
    resize(size() + 1);
    back() = std::move(value);
  }
  template <class... Arguments>
  T& emplace_back(Arguments&&... arguments) {
    push_back(T(std::forward<Arguments>(arguments)...));
    return back();
  }
  void clear() noexcept { *this = ShortVector(); }

  friend bool operator==(const ShortVector& a, const ShortVector& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!(a[i] == b[i])) return false;
    return true;
  }

 private:
  /// Is followed by the elements.
  struct List {
    std::size_t size = 0;
  };
  static_assert(alignof(T) <= alignof(List) && sizeof(List) % alignof(T) == 0);

  /// Makes a list of the elements value(i).
  template <class Value>
  ShortVector(std::size_t size, const Value& value) : ShortVector() {
    if (size == 0) return;
    if (size > (PTRDIFF_MAX - sizeof(List)) / sizeof(T)) throw std::length_error("ShortVector");
    list_ = ::new (::operator new(sizeof(List) + size * sizeof(T))) List;
    for (; list_->size < size; ++list_->size)
      ::new (static_cast<void*>(end())) T(value(list_->size));
  }

  [[nodiscard]] T* first() const noexcept {
    return list_ != nullptr ? reinterpret_cast<T*>(list_ + 1) : nullptr;
  }
  [[nodiscard]] std::size_t checked(std::size_t i) const {
    if (i >= size()) throw std::out_of_range("ShortVector::at");
    return i;
  }

  List* list_ = nullptr;  // null: empty
};

}  // namespace microtrace

#pragma once
/// The arrays of a scene, which own their values or refer to caller-provided memory.

#include <microtrace/error.hpp>
#include <microtrace/shared_handle.hpp>

#include <algorithm>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace microtrace {

/// Reads like a `const std::vector<T>` and grows like a vector; edit() gives write access to the
/// elements. An array either owns its values or borrows memory (see borrow()). Copies of an array
/// share its values until one of them is changed, which copies the values first.
///
/// T must consist of numbers of one type without padding: Vec2, Vec3, Vec4, or a std::array of
/// integers.
///
/// Arrays are as thread-safe as std::vector, even if they share their values. Borrowed memory must
/// not change while any array that refers to it is read.
template <class T>
class Array {
 public:
  using value_type = T;
  using size_type = std::size_t;
  using difference_type = std::ptrdiff_t;
  using const_reference = const T&;
  using reference = const_reference;
  using const_iterator = const T*;
  using iterator = const_iterator;
  using Number = typename T::value_type;  ///< float or std::uint32_t

  Array() = default;
  Array(std::vector<T> values) : values_(values.empty() ? nullptr : new Values) {
    if (values_) values_->own = std::move(values);
  }
  Array(std::initializer_list<T> values) : Array(std::vector<T>(values)) {}

  /// Returns an array that refers to `values` without copying them. The values must not change
  /// while that array or a copy of it exists, including copies inside scenes. `owner` keeps the
  /// memory alive for that time; without an owner, the caller must keep it alive.
  [[nodiscard]] static Array borrow(std::span<const T> values,
                                    std::shared_ptr<const void> owner = {}) {
    Array result;
    if (values.empty()) return result;
    result.values_ = Handle(new Values(values, std::move(owner)));
    return result;
  }

  /// Makes an array from `count` elements in memory, each of sizeof(T) / sizeof(Number) numbers.
  /// Each element begins `stride` bytes after the previous one. Any stride is allowed: 0 repeats
  /// one element, and a negative stride runs backwards.
  ///
  /// Borrows the memory, with `owner` as in borrow(), if it is laid out like an array of T: aligned
  /// for T, with stride sizeof(T) and numbers of the same type (signed integers are accepted for
  /// unsigned ones). Otherwise copies the elements and rounds floating-point numbers to float.
  /// Throws Error (invalid_scene) if a copied integer does not fit into Number.
  template <class Source>
  requires(std::integral<Source>&& std::integral<Number>) ||
      (std::floating_point<Source> && std::floating_point<Number>) [[nodiscard]] static Array
      strided(const Source* first, std::size_t count,
              std::ptrdiff_t stride = kWidth * sizeof(Source),
              std::shared_ptr<const void> owner = {}) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(first);
    if constexpr (is_same_number<Source>) {
      const bool is_aligned = reinterpret_cast<std::uintptr_t>(first) % alignof(T) == 0;
      if (is_aligned && stride == std::ptrdiff_t{sizeof(T)})
        return borrow({reinterpret_cast<const T*>(bytes), count}, std::move(owner));
    }
    std::vector<T> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      Source from[kWidth];
      std::memcpy(from, bytes + static_cast<std::ptrdiff_t>(i) * stride, sizeof from);
      Number to[kWidth];
      std::ranges::transform(from, to, converted<Source>);
      std::memcpy(&values[i], to, sizeof to);
    }
    return values;
  }

  [[nodiscard]] bool is_borrowed() const noexcept { return values_ && values_->is_borrowed(); }

  /// True if the values are borrowed, or if copies of this array share them.
  [[nodiscard]] bool is_shared() const noexcept {
    return is_borrowed() || (values_ && !values_.is_only());
  }

  [[nodiscard]] const T* data() const noexcept { return values_ ? values_->all().data() : nullptr; }
  [[nodiscard]] std::size_t size() const noexcept { return values_ ? values_->all().size() : 0; }
  [[nodiscard]] bool empty() const noexcept { return size() == 0; }
  [[nodiscard]] const T* begin() const noexcept { return data(); }
  [[nodiscard]] const T* end() const noexcept { return data() + size(); }
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return data()[i]; }
  [[nodiscard]] const T& front() const noexcept { return *begin(); }
  [[nodiscard]] const T& back() const noexcept { return end()[-1]; }

  /// Returns the values as a modifiable vector. The reference is valid until the array is copied,
  /// assigned to, moved or destroyed. Values that are borrowed or shared are copied first.
  [[nodiscard]] std::vector<T>& edit() {
    if (!values_ || is_shared()) {
      Handle mine(new Values);
      mine->own.assign(begin(), end());
      values_ = std::move(mine);
    }
    return values_->own;
  }

  /// The following functions behave like those of std::vector and copy values that are borrowed or
  /// shared first, as edit() does.
  void push_back(T value) { edit().push_back(value); }
  template <class... Arguments>
  T& emplace_back(Arguments&&... arguments) {
    push_back(T(std::forward<Arguments>(arguments)...));
    return edit().back();
  }
  void reserve(std::size_t size) { edit().reserve(size); }
  void resize(std::size_t size) { edit().resize(size); }
  void resize(std::size_t size, const T& value) { edit().resize(size, value); }
  void assign(std::size_t size, const T& value) { *this = std::vector<T>(size, value); }
  void clear() noexcept { *this = Array(); }

  friend bool operator==(const Array& a, const Array& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  static constexpr std::size_t kWidth = sizeof(T) / sizeof(Number);
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) == kWidth * sizeof(Number));

  template <class Source>
  static constexpr bool is_same_number = std::is_same_v<Source, Number> ||
                                         (std::integral<Source> && std::integral<Number> &&
                                          sizeof(Source) == sizeof(Number));

  template <class Source>
  static Number converted(Source value) {
    if constexpr (std::integral<Source> && !is_same_number<Source>) {
      if (!std::in_range<Number>(value))
        throw Error(ErrorKind::invalid_scene, "",
                    "index " + std::to_string(value) + " is not in the range of 32-bit numbers");
    }
    return static_cast<Number>(value);
  }

  /// The values of an array and its copies.
  struct Values {
    std::vector<T> own;
    std::span<const T> borrowed;  ///< empty if `own` holds the values
    std::shared_ptr<const void> owner;
    std::atomic<std::uint32_t> users{1};  ///< number of arrays

    Values() = default;
    Values(std::span<const T> values, std::shared_ptr<const void> its_owner)
        : borrowed(values), owner(std::move(its_owner)) {}

    [[nodiscard]] bool is_borrowed() const noexcept { return !borrowed.empty(); }
    [[nodiscard]] std::span<const T> all() const noexcept {
      return is_borrowed() ? borrowed : std::span<const T>(own);
    }
  };

  using Handle = SharedHandle<Values>;

  Handle values_;
};

}  // namespace microtrace

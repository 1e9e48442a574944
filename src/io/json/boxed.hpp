#pragma once

#include <memory>
#include <utility>

namespace microtrace::io {

/// An owned T of the size of a pointer. Copies are deep, and an object that was moved from must not
/// be read.
template <class T>
class Boxed {
 public:
  explicit Boxed(T value) : value_(std::make_unique<T>(std::move(value))) {}
  Boxed(const Boxed& other) : Boxed(*other) {}
  Boxed(Boxed&&) noexcept = default;
  Boxed& operator=(Boxed other) noexcept {
    value_.swap(other.value_);
    return *this;
  }
  ~Boxed() = default;

  [[nodiscard]] T& operator*() { return *value_; }
  [[nodiscard]] const T& operator*() const { return *value_; }

 private:
  std::unique_ptr<T> value_;
};

}  // namespace microtrace::io

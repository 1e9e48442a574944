#pragma once
/// Shared ownership for members of which a scene may have millions.

#include <atomic>
#include <utility>

namespace microtrace {

/// A shared pointer of the size of a pointer. T has a member `users`, the atomic number of its
/// handles, which is 1 for a new object. As thread-safe as std::shared_ptr.
template <class T>
class SharedHandle {
 public:
  explicit SharedHandle(T* object = nullptr) noexcept : object_(object) {}
  SharedHandle(const SharedHandle& other) noexcept : object_(other.object_) {
    if (object_ != nullptr) object_->users.fetch_add(1, std::memory_order_relaxed);
  }
  SharedHandle(SharedHandle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  SharedHandle& operator=(SharedHandle other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~SharedHandle() {
    if (object_ != nullptr && object_->users.fetch_sub(1, std::memory_order_acq_rel) == 1)
      delete object_;
  }
  [[nodiscard]] bool is_only() const noexcept {
    return object_->users.load(std::memory_order_acquire) == 1;
  }
  explicit operator bool() const noexcept { return object_ != nullptr; }
  T* operator->() const noexcept { return object_; }

 private:
  T* object_;
};

}  // namespace microtrace

#pragma once
/// The names of objects, of which a scene may have millions.

#include <microtrace/export.hpp>
#include <microtrace/shared_handle.hpp>

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

namespace microtrace {

/// An immutable text. Names that differ only in a number share the rest of their text, which is put
/// together by str(). May be copied and destroyed by any number of threads.
class MICROTRACE_EXPORT ObjectName {
 public:
  ObjectName() = default;
  ObjectName(std::string_view text);  // NOLINT(google-explicit-constructor)
  ObjectName(const std::string& text) : ObjectName(std::string_view(text)) {}  // NOLINT
  ObjectName(const char* text) : ObjectName(std::string_view(text)) {}         // NOLINT

  /// Returns the name that consists of `head`, the number 0 and `tail`.
  [[nodiscard]] static ObjectName numbered(std::string_view head, std::string_view tail);
  /// Returns a numbered name with another number, which shares the text. Returns other names
  /// unchanged.
  [[nodiscard]] ObjectName with_number(std::uint32_t number) const;

  [[nodiscard]] std::string str() const;
  [[nodiscard]] bool empty() const { return !text_; }

  friend bool operator==(const ObjectName& a, const ObjectName& b) { return a.str() == b.str(); }

 private:
  ObjectName(std::string_view head, std::string_view tail, bool is_numbered);

  /// Is followed by the characters of the head and of the tail.
  struct Text {
    std::uint32_t head, tail;  ///< sizes; there is a number between them if is_numbered
    bool is_numbered;
    std::atomic<std::uint32_t> users{1};  ///< number of names

    // Without the size, which would leave out the characters.
    // NOLINTNEXTLINE(misc-new-delete-overloads): constructed in memory of ::operator new
    static void operator delete(void* text) { ::operator delete(text); }
  };

  SharedHandle<Text> text_{};  // null: an empty name
  std::uint32_t number_ = 0;
};

}  // namespace microtrace

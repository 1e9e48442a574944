#pragma once
/// The text of an option's value, and conversions of this text.

#include <microtrace/math.hpp>

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::cli {

/// Parses decimal digits without a sign; nothing for any other text.
[[nodiscard]] std::optional<std::uint32_t> whole_number(std::string_view text);

/// Parses comma-separated finite numbers. Returns an empty list for any other text.
[[nodiscard]] std::vector<double> numbers_of(std::string_view text);

/// Joins the words, as in "a, b or c".
[[nodiscard]] std::string listed(std::span<const std::string> words);

/// A name that an option accepts as its value.
template <class T>
struct Choice {
  std::string_view name;
  T value;
};

template <class Choices>
[[nodiscard]] std::vector<std::string> names_of(const Choices& choices) {
  std::vector<std::string> names;
  names.reserve(choices.size());
  for (const auto& choice : choices) names.emplace_back(choice.name);
  return names;
}

/// The text of an option's value. Each conversion throws Error (usage) with the option's name and
/// the values that it accepts.
struct OptionValue {
  std::string option;  ///< name of the option, such as "--size"
  std::string text;

  [[nodiscard]] std::uint32_t whole_number(std::uint32_t least, std::uint32_t most) const;
  [[nodiscard]] double number() const;
  /// Accepts numbers from `least` to `most`, both included.
  [[nodiscard]] double number(double least, double most) const;
  [[nodiscard]] double positive_number() const;
  [[nodiscard]] double seconds() const { return number(0, std::numeric_limits<double>::max()); }
  [[nodiscard]] DVec3 point() const;
  /// Accepts a positive number of bytes. The suffix K, M or G stands for KiB, MiB or GiB.
  [[nodiscard]] std::uint64_t bytes() const;

  template <class Choices>
  [[nodiscard]] auto choice(const Choices& choices) const {
    for (const auto& choice : choices) {
      if (choice.name == text) return choice.value;
    }
    refuse(listed(names_of(choices)));
  }

  /// Throws Error (usage) with the message "--size: expects {accepted}, not {text}".
  [[noreturn]] void refuse(const std::string& accepted) const;
};

/// Returns the number as text with at most six digits.
[[nodiscard]] std::string shortest(double number);

/// Throws Error (usage) with this message.
[[noreturn]] void refuse_usage(const std::string& message);

}  // namespace microtrace::cli

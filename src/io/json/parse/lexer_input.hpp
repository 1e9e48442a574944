#pragma once
/// Passes the characters of a JSON text to nlohmann's lexer, but spares it what it would only copy.

#include "base/memory_account.hpp"

#include <cstddef>
#include <iterator>
#include <string_view>

namespace microtrace::io {

/// The lexer keeps each token and the white space before it, and writes them several times into an
/// error's message. The input therefore shortens two of them:
/// - It passes one character of white space in place of several.
/// - It passes no content of long strings without escapes, such as data URIs. It also passes none
///   of long strings that aren't closed.
/// It charges the memory for other long tokens.
class LexerInput {
 public:
  /// The length from which strings and tokens are long, in bytes.
  static constexpr std::size_t kLong = std::size_t{1} << 16U;

  explicit LexerInput(std::string_view text) : text_(text) {}

  [[nodiscard]] char current() const { return text_[at_]; }
  [[nodiscard]] bool at_end() const { return at_ == text_.size(); }
  /// The number of bytes that are read, including those that were not passed.
  [[nodiscard]] std::size_t read() const { return at_; }

  /// The end of the string token that was read last.
  [[nodiscard]] std::size_t string_end() const { return string_end_; }

  void advance() {
    if (at_ < string_end_ || (at_ < next_inspected_ && text_[at_] > '"')) {
      ++at_;
    } else {
      advance_between_strings();
    }
  }

 private:
  void advance_between_strings();
  void open_string();
  /// Charges the memory for a token of a length that is known to be passed.
  void charge(std::size_t length);

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t string_end_ = 0;      // characters before are content of a string
  std::size_t next_inspected_ = 0;  // the next character that may begin a long number
  std::size_t charged_ = 0;         // the length of the longest charged token
  MemoryAccount memory_{memory_account().budget()};
};

/// An iterator for nlohmann::json::sax_parse.
class LexerIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = char;

  explicit LexerIterator(LexerInput* input) : input_(input) {}

  char operator*() const { return input_->current(); }
  LexerIterator& operator++() {
    input_->advance();
    return *this;
  }
  void operator++(int) { input_->advance(); }
  /// Compares with the end, the only iterator that another one is compared with.
  bool operator==(const LexerIterator& /*end*/) const { return input_->at_end(); }

 private:
  LexerInput* input_;
};

}  // namespace microtrace::io

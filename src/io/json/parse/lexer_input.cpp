#include "io/json/parse/lexer_input.hpp"

#include "io/json/parse/token.hpp"

#include <algorithm>

namespace microtrace::io {
namespace {

constexpr std::string_view kEndsOfNumbers = " \t\r\n,:[]{}\"";

}  // namespace

void LexerInput::advance_between_strings() {
  const char c = text_[at_];
  if (c == '"') {
    open_string();
  } else if (c <= ' ') {
    at_ = std::max(skip_whitespace(text_, at_), at_ + 1);
  } else if (at_++ >= next_inspected_) {
    // Inspects only one character in so many, because most numbers are short.
    const std::size_t end = std::min(text_.find_first_of(kEndsOfNumbers, at_), text_.size());
    if (end - at_ > kLong) charge(end - at_);
    next_inspected_ = end + kLong;
  }
}

void LexerInput::open_string() {
  const StringExtent extent = string_extent(text_, at_);
  const std::size_t length = extent.end - at_;
  string_end_ = extent.is_closed ? extent.end : text_.size();
  if (length > kLong && (extent.is_verbatim || !extent.is_closed)) {
    at_ = extent.is_closed ? extent.end - 1 : extent.end;
  } else {
    if (length > kLong) charge(length);
    ++at_;
  }
}

void LexerInput::charge(std::size_t length) {
  if (length <= charged_) return;
  // The lexer's two copies, which grow by doubling, and those in an error's message.
  constexpr std::size_t kCopies = 8;
  memory_.take(kCopies * (length - charged_), "a string or number of JSON");
  charged_ = length;
}

}  // namespace microtrace::io

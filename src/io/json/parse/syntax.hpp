#pragma once
/// Writes short messages about syntax errors.

#include <cstddef>
#include <string>
#include <string_view>

namespace microtrace::io {

/// The position and the state in which parsing stopped.
struct SyntaxContext {
  enum class Expects {
    value,           ///< at the start, after a colon, or after a comma in an array
    value_or_end,    ///< after [
    key,             ///< after a comma in an object
    key_or_end,      ///< after {
    colon,           ///< after a key
    comma_or_end,    ///< after a value in an array or an object
    end_of_document  ///< after the root
  };
  Expects expects = Expects::value;
  bool in_object = false;
  std::size_t token = 0;  ///< byte offset of the unexpected token
  std::size_t comma = 0;  ///< byte offset of the comma before the token, if there is one
  std::size_t read = 0;   ///< end of the bytes that the lexer has read
};

struct SyntaxError {
  std::size_t offset = 0;
  std::string message;
};

/// Makes the message for a syntax error. `reason` is the parser's message. It begins with "invalid
/// string: ", "invalid number; " or "invalid literal" if the token is malformed. Any other text
/// means that the token is valid but in the wrong place.
[[nodiscard]] SyntaxError explain(std::string_view text, const SyntaxContext& context,
                                  std::string_view reason);

/// Makes the message about a valid token in the wrong place.
[[nodiscard]] SyntaxError explain_misplaced(std::string_view text, const SyntaxContext& context);

}  // namespace microtrace::io

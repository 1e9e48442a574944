#pragma once
/// What is wrong with a text that is not JSON, said in a short plain sentence.

#include <cstddef>
#include <string>
#include <string_view>

namespace microtrace::io {

/// Where reading stopped.
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
  std::size_t token = 0;  ///< byte at which the token that does not fit starts
  std::size_t comma = 0;  ///< of the comma before it, if there is one
  std::size_t read = 0;   ///< end of what the lexer has read of the token
};

struct SyntaxError {
  std::size_t offset = 0;
  std::string message;
};

/// `reason` is what nlohmann-json's lexer says of the token: "invalid string: ...", "invalid
/// number; ...", "invalid literal", anything else if the token itself is right but misplaced.
[[nodiscard]] SyntaxError explain(std::string_view text, const SyntaxContext& context,
                                  std::string_view reason);

/// The message about a token that is whole but stands in the wrong place.
[[nodiscard]] SyntaxError explain_misplaced(std::string_view text, const SyntaxContext& context);

}  // namespace microtrace::io

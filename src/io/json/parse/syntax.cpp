#include "io/json/parse/syntax.hpp"

#include "base/text/printable.hpp"

#include <algorithm>

namespace microtrace::io {
namespace {

using Expects = SyntaxContext::Expects;

bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '+' || c == '-' || c == '.' || c == '$' || static_cast<unsigned char>(c) >= 0x80;
}

std::string_view word_at(std::string_view text, std::size_t offset) {
  std::size_t end = offset;
  while (end < text.size() && end - offset < 80 && is_word(text[end])) ++end;
  return text.substr(offset, std::max<std::size_t>(end - offset, 1));
}

std::string expected(const SyntaxContext& context) {
  const std::string end = context.in_object ? "'}'" : "']'";
  switch (context.expects) {
    case Expects::value:
      return "a value";
    case Expects::value_or_end:
      return "a value or ']'";
    case Expects::key:
      return "a key in double quotes";
    case Expects::key_or_end:
      return "a key in double quotes or '}'";
    case Expects::colon:
      return "':' after the key";
    case Expects::comma_or_end:
      return std::string("',' or ").append(end);
    case Expects::end_of_document:
      return "nothing more after the end of the JSON value";
  }
  return {};
}

std::string found(std::string_view text, std::size_t offset) {
  if (offset >= text.size()) return "the end of the text";
  const char c = text[offset];
  if (c == '"') return "a string";
  if (text.substr(offset).starts_with("\xC2\xA0")) return "a no-break space (U+00A0)";
  if (std::string_view("{}[]:,").find(c) != std::string_view::npos) return {'\'', c, '\''};
  return in_quotes(word_at(text, offset));
}

/// Returns the ASCII character of which the first character is the full-width form, which Chinese
/// and Japanese keyboards type; 0 if it is none.
char narrow_form(std::string_view text) {
  // U+FF01 to U+FF5E are the forms of ! to ~.
  if (text.empty() || character_length(text) != 3 || text[0] != '\xEF') return 0;
  const unsigned second = static_cast<unsigned char>(text[1]) & 0x3FU;
  const unsigned code = second << 6U | (static_cast<unsigned char>(text[2]) & 0x3FU);
  return code >= 0xF01 && code <= 0xF5E ? static_cast<char>(code - 0xF01 + '!') : '\0';
}

std::string unexpected(std::string_view text, const SyntaxContext& context) {
  std::string message = "expected ";
  message.append(expected(context)).append(", found ").append(found(text, context.token));
  const std::string_view rest = text.substr(std::min(context.token, text.size()));
  if (const char narrow = narrow_form(rest); narrow != 0)
    message.append("; JSON needs the ASCII character ") += narrow;
  return message;
}

SyntaxError explain_string(const SyntaxContext& context, std::string_view text,
                           std::string_view reason) {
  const std::size_t last = context.read - 1;  // the byte that the lexer rejected
  const auto says = [&](std::string_view part) {
    return reason.find(part) != std::string_view::npos;
  };
  if (says("closing quote")) return {context.token, "the string that starts here is not closed"};
  if (says("UTF-8")) return {last, "is not UTF-8 here; save the file as UTF-8"};
  if (says("control character")) {
    if (text[last] == '\n' || text[last] == '\r') {
      return {context.token,
              "the string that starts here is not closed on its line; a line break "
              "within a string is written \\n"};
    }
    return {last, "a control character within a string must be escaped, as in \\t or \\u0009"};
  }
  if (says("backslash")) {
    return {last,
            "unknown escape; a backslash must be followed by \" \\ / b f n r t or u and four hex "
            "digits"};
  }
  if (says("4 hex digits")) return {last, "\\u must be followed by four hex digits"};
  return {last, "a \\u surrogate must be part of a pair, high then low"};
}

/// Returns the JSON value that other languages write as `word`, empty if there is none.
std::string_view meant_by(std::string_view word) {
  if (word == "True" || word == "TRUE") return "true";
  if (word == "False" || word == "FALSE") return "false";
  if (word == "None" || word == "NULL" || word == "Null" || word == "nil") return "null";
  return {};
}

/// Returns true for text that begins as JSON in UTF-16 without a byte order mark does.
bool is_utf16(std::string_view text) {
  return text.size() >= 2 && text.size() % 2 == 0 && (text[0] == '\0') != (text[1] == '\0');
}

SyntaxError explain_literal(std::string_view text, const SyntaxContext& context) {
  const std::string_view rest = text.substr(context.token);
  if (rest.starts_with("\xFF\xFE") || rest.starts_with("\xFE\xFF") ||
      (rest[0] == '\xEF' && character_length(rest) == 0)) {
    return {context.token, "is not UTF-8 here; save the file as UTF-8"};
  }
  if (rest.starts_with("\xEF\xBB\xBF")) {
    return {context.token, "a byte order mark is allowed only at the start; remove it"};
  }
  if (rest.starts_with("//") || rest.starts_with("/*") || rest[0] == '#') {
    return {context.token, "comments are not JSON; remove it"};
  }
  if (rest[0] == '\'') return {context.token, "JSON strings need double quotes"};
  const std::string_view word = word_at(text, context.token);
  const std::string_view bare = word.substr(word[0] == '-' || word[0] == '+' ? 1 : 0);
  if (bare == "NaN" || bare == "nan" || bare == "Infinity" || bare == "inf") {
    return {context.token, in_quotes(word).append(" is not JSON; write a finite number")};
  }
  if (context.expects == Expects::key || context.expects == Expects::key_or_end) {
    return explain_misplaced(text, context);
  }
  std::string message = unexpected(text, context);
  if (const std::string_view meant = meant_by(word); !meant.empty())
    message.append("; JSON has ").append(meant);
  if (word[0] == '+') message += "; JSON numbers have no plus sign";
  if (word[0] == '.') message += "; JSON numbers start with a digit";
  return {context.token, message};
}

}  // namespace

SyntaxError explain_misplaced(std::string_view text, const SyntaxContext& context) {
  const char c = context.token < text.size() ? text[context.token] : ' ';
  const bool after_comma =
      context.expects == Expects::key || (context.expects == Expects::value && context.comma != 0);
  if (after_comma && (c == '}' || c == ']')) {
    std::string message = "a comma is not allowed before '";
    message += c;
    return {context.comma, message.append("'; remove it")};
  }
  if (context.token < text.size() && c == '\0') {
    if (context.token < 2 && is_utf16(text))
      return {context.token, "is UTF-16, not UTF-8; save the file as UTF-8"};
    return {context.token, "a zero byte is outside of strings; this is not a JSON text"};
  }
  std::string message = unexpected(text, context);
  const bool ends_value =
      context.expects == Expects::comma_or_end || context.expects == Expects::end_of_document;
  if (ends_value && c >= '0' && c <= '9' && text[context.token - 1] == '0')
    message += "; JSON numbers don't start with 0";
  return {std::min(context.token, text.size()), message};
}

SyntaxError explain(std::string_view text, const SyntaxContext& context, std::string_view reason) {
  if (context.token >= text.size()) return explain_misplaced(text, context);
  if (reason.starts_with("invalid string")) return explain_string(context, text, reason);
  const std::string_view word = word_at(text, context.token);
  if (reason.starts_with("invalid number") && !word.starts_with("-I")) {
    const std::size_t colon = reason.find("; ");
    std::string message = in_quotes(word).append(" is not a JSON number");
    if (colon != std::string_view::npos) message.append(": ").append(reason.substr(colon + 2));
    return {context.token, message};
  }
  if (reason.starts_with("invalid")) return explain_literal(text, context);
  return explain_misplaced(text, context);
}

}  // namespace microtrace::io

#include "io/json/document.hpp"

#include "base/text/printable.hpp"
#include "io/json/excerpt.hpp"
#include "io/json/parse/token.hpp"
#include "io/json/parse/tree_builder.hpp"

#include <algorithm>
#include <utility>

namespace microtrace::io {

JsonDocument::JsonDocument(std::string_view text, std::string file, std::size_t max_values,
                           RepeatedKeys repeated)
    : text_(text), file_(std::move(file)) {
  if (text.size() > kMaxJsonSize) {
    throw Error(ErrorKind::limit, file_, "the JSON text is larger than 1 GiB");
  }
  std::string_view content = text;
  if (content.starts_with(kByteOrderMark)) content.remove_prefix(kByteOrderMark.size());
  if (skip_whitespace(content, 0) == content.size()) {
    throw Error(ErrorKind::invalid_scene, file_, "is empty");
  }
  build_tree(*this, text, root_, max_values, repeated, outdone_keys_);
}

Diagnostic JsonDocument::at(std::size_t offset, const std::string& pointer,
                            std::string message) const {
  // The byte order mark doesn't count as part of the first line.
  const std::size_t skipped = text_.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  const std::string_view text = text_.substr(skipped);
  offset = std::min(offset - std::min(offset, skipped), text.size());
  const Place place = place_of(text, offset);
  return {.file = file_,
          .line = place.line,
          .column = place.column,
          .pointer = printable(pointer),
          .message = std::move(message),
          .excerpt = excerpt(text, offset)};
}

void JsonDocument::fail(std::size_t offset, const std::string& pointer, std::string message,
                        const Error& cause) const {
  Diagnostic diagnostic = at(offset, pointer, std::move(message));
  diagnostic.system_error = cause.diagnostic().system_error;
  throw Error(cause.kind(), std::move(diagnostic));
}

}  // namespace microtrace::io

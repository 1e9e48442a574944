#include "base/system/error_text.hpp"

#include <clocale>
#include <cstring>

namespace microtrace {

std::string error_text(int error) {
  static const locale_t plain = ::newlocale(LC_ALL_MASK, "C", nullptr);
  return plain != nullptr ? ::strerror_l(error, plain) : "error " + std::to_string(error);
}

}  // namespace microtrace

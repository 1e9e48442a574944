/// Translates the names of members in errors, by the lists in fields.hpp.

#include "member_names.hpp"

#include "fields.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace microtrace::python {
namespace {

template <class T>
struct PartOf {
  using Type = void;
};
template <class T>
requires requires {
  Class<T>::kFields;
}
struct PartOf<std::optional<T>> {
  using Type = T;
};

/// Replaces a word wherever it stands alone.
void replace_word(std::string& text, std::string_view word, std::string_view by) {
  const auto is_letter = [&](std::size_t i) {
    return i < text.size() && (text[i] == '_' || std::isalnum(static_cast<unsigned char>(text[i])));
  };
  std::size_t at = 0;
  while ((at = text.find(word, at)) != std::string::npos) {
    if ((at > 0 && is_letter(at - 1)) || is_letter(at + word.size())) {
      at += word.size();
    } else {
      text.replace(at, word.size(), by);
      at += by.size();
    }
  }
}

class Translation {
 public:
  explicit Translation(Diagnostic original) : result_(std::move(original)) {
    for (std::size_t begin = 1; begin <= result_.pointer.size();) {
      const std::size_t end = std::min(result_.pointer.find('/', begin), result_.pointer.size());
      tokens_.push_back(result_.pointer.substr(begin, end - begin));
      begin = end + 1;
    }
  }

  Diagnostic operator()() {
    if (is(0, "objects")) {
      if (is(3, "placement")) remove(2);  // Python's meshes have no placement
      rename<Mesh>(3);
    } else if (is(0, "materials")) {
      rename<Material>(2);
    } else if (is(0, "lights")) {
      remove(2);             // Python's lights have their names as attributes
      rename<SpotLight>(2);  // has the members of all lights
    } else if (is(0, "cameras")) {
      remove(2);
      rename<CalibratedCamera>(2);
    } else if (is(0, "camera")) {
      rename<CalibratedCamera>(1);
    }
    result_.pointer.clear();
    for (const std::string& token : tokens_) result_.pointer.append("/").append(token);
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool is(std::size_t place, std::string_view token) const {
    return place < tokens_.size() && tokens_[place] == token;
  }
  void remove(std::size_t place) {
    if (place < tokens_.size()) tokens_.erase(tokens_.begin() + static_cast<std::ptrdiff_t>(place));
  }

  /// Translates the token at `place`, a member of T, those after it, and the message.
  template <class T>
  void rename(std::size_t place) {
    if (place >= tokens_.size()) return;
    const std::string member = tokens_[place];
    const auto translate = [&]<class Member>(const Field<T, Member>& field) {
      replace_word(result_.message, field.member_name, field.name);
      if (member != field.member_name) return;
      tokens_[place] = field.name;
      using Part = typename PartOf<Member>::Type;
      if constexpr (!std::is_void_v<Part>) rename<Part>(place + 1);
    };
    std::apply([&](const auto&... field) { (translate(field), ...); }, Class<T>::kFields);
  }

  Diagnostic result_;
  std::vector<std::string> tokens_;  // of the pointer
};

}  // namespace

void with_python_names(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& error) {
    throw Error(error.kind(), Translation(error.diagnostic())());
  }
}

}  // namespace microtrace::python

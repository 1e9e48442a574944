#include "io/json/parse/tree_builder.hpp"

#include "base/text/printable.hpp"
#include "io/json/members.hpp"
#include "io/json/parse/lexer_input.hpp"
#include "io/json/parse/syntax.hpp"
#include "io/json/parse/token.hpp"
#include "io/json/parse/tree_memory.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>

#include <nlohmann/json.hpp>

namespace microtrace::io {
namespace {

/// Builds the tree from nlohmann-json's events, which have no positions. Between two events there
/// are only white space and at most one comma or colon. The start of each token therefore follows
/// from the end of the previous one.
class TreeBuilder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(const JsonDocument& document, std::string_view text, const LexerInput& input,
              JsonValue& root, std::size_t max_values, RepeatedKeys policy,
              OutdoneKeys& outdone_keys)
      : document_(document),
        text_(text),
        input_(input),
        root_(root),
        max_values_(max_values),
        policy_(policy),
        outdone_keys_(outdone_keys),
        end_(text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0) {}

  bool null() override { return scalar(JsonValue(), 4); }
  bool boolean(bool value) override { return scalar(JsonValue(value), value ? 4 : 5); }

  bool number_integer(number_integer_t value) override {
    return number(static_cast<double>(value));
  }

  bool number_unsigned(number_unsigned_t value) override {
    return number(static_cast<double>(value));
  }

  bool number_float(number_float_t value, const string_t& /*token*/) override {
    return number(value);
  }

  bool string(string_t& value) override {
    const std::size_t start = next_token().token;
    const std::string_view content = string_content(value, start);
    memory_.take_boxed(content.size());
    return scalar(JsonValue(std::string(content)), input_.string_end() - start);
  }

  bool binary(binary_t& /*value*/) override { return false; }  // never called for JSON texts
  bool start_object(std::size_t /*size*/) override { return open(JsonValue::Kind::object); }
  bool start_array(std::size_t /*size*/) override { return open(JsonValue::Kind::array); }

  bool end_object() override {
    std::vector<JsonMember> members = taken(members_, open_.back().first_member);
    make_keys_unique(members);
    return close(JsonValue(std::move(members)));
  }

  bool end_array() override { return close(JsonValue(taken(items_, open_.back().first_item))); }

  bool key(string_t& name) override {
    const std::size_t start = next_token().token;
    end_ = input_.string_end();
    const std::string_view content = string_content(name, start);
    memory_.take_member(content.size());
    memory_.push(members_, JsonMember{.key = std::string(content), .value = {}});
    members_.back().value.key_offset = static_cast<std::uint32_t>(start);
    last_ = Last::key;
    return true;
  }

  bool parse_error(std::size_t /*position*/, const std::string& /*token*/,
                   const nlohmann::detail::exception& error) override {
    SyntaxContext context = next_token();
    context.read = input_.read();
    if (error.id == 406) {
      fail(ErrorKind::invalid_scene, context.token,
           "the number is out of range; the largest is about 1.8e308");
    }
    // what() has the form "... syntax error while parsing value - REASON; last read: ...".
    std::string_view reason = error.what();
    reason.remove_prefix(std::min(reason.find(" - ") + 3, reason.size()));
    reason = reason.substr(0, reason.find("; last read"));
    fail(explain(text_, context, reason));
  }

  /// Throws Error if anything follows the root value, because the parser stops at a zero byte.
  void require_end() const {
    const SyntaxContext context = next_token();
    if (context.token != text_.size()) fail(explain_misplaced(text_, context));
  }

 private:
  enum class Last { open, key, value };

  /// An array or object whose end has not been read.
  struct Open {
    JsonValue::Kind kind;
    std::size_t offset;
    std::size_t first_item, first_member;  ///< of its own among all that are open
  };

  /// Returns the elements from `first` on and removes them.
  template <class T>
  static std::vector<T> taken(std::vector<T>& all, std::size_t first) {
    const auto from = all.begin() + static_cast<std::ptrdiff_t>(first);
    std::vector<T> result(std::make_move_iterator(from), std::make_move_iterator(all.end()));
    all.erase(from, all.end());
    return result;
  }

  /// Returns the content of the string token that was read last. The lexer's value is empty if the
  /// content was not passed to it.
  [[nodiscard]] std::string_view string_content(std::string_view value, std::size_t start) const {
    return value.empty() ? text_.substr(start + 1, input_.string_end() - start - 2) : value;
  }

  /// Returns the position of the next token, and the tokens allowed there.
  [[nodiscard]] SyntaxContext next_token() const {
    using enum SyntaxContext::Expects;
    SyntaxContext context{
        .in_object = !open_.empty() && open_.back().kind == JsonValue::Kind::object,
        .token = skip_whitespace(text_, end_)};
    const std::string_view rest = text_.substr(context.token);
    if (last_ == Last::key) {
      context.expects = rest.starts_with(':') ? value : colon;
      if (rest.starts_with(':')) context.token = skip_whitespace(text_, context.token + 1);
    } else if (open_.empty()) {
      context.expects = last_ == Last::open ? value : end_of_document;
    } else if (last_ == Last::open) {
      context.expects = context.in_object ? key_or_end : value_or_end;
    } else if (rest.starts_with(',')) {
      context.expects = context.in_object ? key : value;
      context.comma = std::exchange(context.token, skip_whitespace(text_, context.token + 1));
    } else {
      context.expects = comma_or_end;
    }
    return context;
  }

  void count(std::size_t offset) {
    if (++count_ > max_values_) {
      fail(ErrorKind::limit, offset,
           std::string("the text has more values than ")
               .append(std::to_string(max_values_))
               .append(", the limit"));
    }
  }

  /// Adds a value to the innermost open one.
  bool add(JsonValue value, std::size_t offset) {
    value.offset = static_cast<std::uint32_t>(offset);
    last_ = Last::value;
    if (open_.empty()) {
      root_ = std::move(value);
    } else if (open_.back().kind == JsonValue::Kind::array) {
      memory_.take_item();
      memory_.push(items_, std::move(value));
    } else {
      JsonValue& member = members_.back().value;
      value.key_offset = member.key_offset;
      member = std::move(value);
    }
    return true;
  }

  bool scalar(JsonValue value, std::size_t length) {
    const std::size_t start = next_token().token;
    end_ = start + length;
    count(start);
    return add(std::move(value), start);
  }

  bool number(double value) {
    const std::size_t start = next_token().token;
    // nlohmann's lexer reads -0 as the integer 0.
    return scalar(JsonValue(text_[start] == '-' ? -std::abs(value) : value),
                  number_end(text_, start) - start);
  }

  bool open(JsonValue::Kind kind) {
    const std::size_t start = next_token().token;
    if (open_.size() == kMaxJsonDepth) {
      // The error has no JSON pointer, because at this depth the pointer would be extremely long.
      throw Error(ErrorKind::limit,
                  document_.at(start, "", "arrays and objects are nested more than 256 deep"));
    }
    count(start);
    memory_.take_container();
    open_.push_back({kind, start, items_.size(), members_.size()});
    end_ = start + 1;
    last_ = Last::open;
    return true;
  }

  bool close(JsonValue value) {
    end_ = next_token().token + 1;
    const std::size_t offset = open_.back().offset;
    open_.pop_back();
    return add(std::move(value), offset);
  }

  void make_keys_unique(std::vector<JsonMember>& members) {
    const MemoryAccount keys = memory_of_keys(members.size());
    const RepeatedMembers repeated = repeated_members(members);
    const std::vector<std::size_t>& outdone = repeated.outdone;
    if (outdone.empty()) return;
    if (policy_ == RepeatedKeys::are_refused) {
      fail({repeated.first, "the key " + in_quotes(repeated.key) + " occurs twice in this object"});
    }
    note_outdone(members, outdone);
    std::erase_if(members, [&](const JsonMember& member) {
      return std::binary_search(outdone.begin(), outdone.end(), member.value.key_offset);
    });
  }

  /// Records an object's duplicate keys. Makes a pointer, which may be as long as the text, only
  /// for the first duplicate known so far. An enclosing object ends later but may have an earlier
  /// one.
  void note_outdone(const std::vector<JsonMember>& members,
                    const std::vector<std::size_t>& offsets) {
    const bool is_first = outdone_keys_.count == 0 || offsets.front() < outdone_keys_.offset;
    outdone_keys_.count += offsets.size();
    if (!is_first) return;
    const auto first = std::ranges::find(members, offsets.front(),
                                         [](const JsonMember& m) { return m.value.key_offset; });
    outdone_keys_.offset = offsets.front();
    outdone_keys_.pointer = child(pointer(), first->key);
  }

  /// Returns the pointer to the innermost open value, or to the member whose key was read last.
  [[nodiscard]] std::string pointer() const {
    std::string out;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const bool is_innermost = i + 1 == open_.size();
      const std::size_t items = is_innermost ? items_.size() : open_[i + 1].first_item;
      const std::size_t members = is_innermost ? members_.size() : open_[i + 1].first_member;
      if (open_[i].kind == JsonValue::Kind::array) {
        if (!is_innermost) out = child(out, items - open_[i].first_item);
      } else if (!is_innermost || last_ == Last::key) {
        out = child(out, members_[members - 1].key);
      }
    }
    return out;
  }

  [[noreturn]] void fail(ErrorKind kind, std::size_t offset, std::string message) const {
    throw Error(kind, document_.at(offset, pointer(), std::move(message)));
  }

  [[noreturn]] void fail(SyntaxError error) const {
    fail(ErrorKind::invalid_scene, error.offset, std::move(error.message));
  }

  const JsonDocument& document_;
  std::string_view text_;
  const LexerInput& input_;
  JsonValue& root_;
  std::size_t max_values_;
  RepeatedKeys policy_;
  OutdoneKeys& outdone_keys_;
  std::vector<Open> open_;           // from the root to the innermost
  std::vector<JsonValue> items_;     // of all open arrays
  std::vector<JsonMember> members_;  // of all open objects
  std::size_t end_ = 0;              // end of the last token
  Last last_ = Last::open;
  std::size_t count_ = 0;  // number of values
  TreeMemory memory_;
};

}  // namespace

void build_tree(const JsonDocument& document, std::string_view text, JsonValue& root,
                std::size_t max_values, RepeatedKeys policy, OutdoneKeys& outdone_keys) {
  LexerInput input(text);
  TreeBuilder builder(document, text, input, root, max_values, policy, outdone_keys);
  nlohmann::json::sax_parse(LexerIterator(&input), LexerIterator(&input), &builder);
  builder.require_end();
}

}  // namespace microtrace::io

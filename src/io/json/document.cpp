#include "io/json/document.hpp"

#include "base/memory_account.hpp"
#include "base/printable.hpp"
#include "io/json/excerpt.hpp"
#include "io/json/members.hpp"
#include "io/json/syntax.hpp"
#include "io/json/token.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <nlohmann/json.hpp>

namespace microtrace::io {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kWhitespace = " \t\r\n";

/// Builds the tree from nlohmann-json's events, which have no positions. Between two events there
/// are only white space and at most one comma or colon. The start of each token therefore follows
/// from the end of the previous one.
class TreeBuilder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(const JsonDocument& document, std::string_view text, JsonValue& root,
              std::size_t max_values, RepeatedKeys policy, OutdoneKeys& outdone_keys)
      : document_(document),
        text_(text),
        root_(root),
        max_values_(max_values),
        policy_(policy),
        outdone_keys_(outdone_keys),
        end_(text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0) {}

  bool null() override { return scalar(of_kind(JsonValue::Kind::null), 4); }

  bool boolean(bool value) override {
    JsonValue result = of_kind(JsonValue::Kind::boolean);
    result.boolean = value;
    return scalar(std::move(result), value ? 4 : 5);
  }

  bool number_integer(number_integer_t value) override {
    return number(static_cast<double>(value), std::abs(static_cast<double>(value)) <= 0x1p53);
  }

  bool number_unsigned(number_unsigned_t value) override {
    return number(static_cast<double>(value), value <= std::uint64_t{1} << 53U);
  }

  bool number_float(number_float_t value, const string_t& /*token*/) override {
    return number(value, false);
  }

  bool string(string_t& value) override {
    const std::size_t start = next_token().token;
    JsonValue result = of_kind(JsonValue::Kind::string);
    if (value.size() > kLongString) take_memory(2 * value.size(), "the strings of JSON");
    result.string = std::move(value);
    return scalar(std::move(result), string_end(text_, start) - start);
  }

  bool binary(binary_t& /*value*/) override { return false; }  // never called for JSON texts
  bool start_object(std::size_t /*size*/) override { return open(JsonValue::Kind::object); }
  bool start_array(std::size_t /*size*/) override { return open(JsonValue::Kind::array); }

  bool end_object() override {
    make_keys_unique(*open_.back());
    open_.back()->index_members();
    return close();
  }

  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    const std::size_t start = next_token().token;
    JsonValue& parent = *open_.back();
    parent.members.push_back({std::move(name), {}});
    parent.members.back().value.key_offset = start;
    end_ = string_end(text_, start);
    last_ = Last::key;
    return true;
  }

  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& error) override {
    SyntaxContext context = next_token();
    context.read = std::min(position, text_.size());
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
  /// Memory is counted in blocks of this many values. A value's size includes the unused capacity
  /// of vectors.
  static constexpr std::size_t kBlock = 1024, kBytesOfValue = 2 * sizeof(JsonValue);
  static constexpr std::size_t kLongString = 256;

  enum class Last { open, key, value };

  [[nodiscard]] std::size_t skip_whitespace(std::size_t offset) const {
    return std::min(text_.find_first_not_of(kWhitespace, offset), text_.size());
  }

  /// Returns the position of the next token, and the tokens allowed there.
  [[nodiscard]] SyntaxContext next_token() const {
    using Expects = SyntaxContext::Expects;
    SyntaxContext context{
        .in_object = !open_.empty() && open_.back()->kind == JsonValue::Kind::object,
        .token = skip_whitespace(end_)};
    const std::string_view rest = text_.substr(context.token);
    if (last_ == Last::key) {
      context.expects = rest.starts_with(':') ? Expects::value : Expects::colon;
      if (rest.starts_with(':')) context.token = skip_whitespace(context.token + 1);
    } else if (open_.empty()) {
      context.expects = last_ == Last::open ? Expects::value : Expects::end_of_document;
    } else if (last_ == Last::open) {
      context.expects = context.in_object ? Expects::key_or_end : Expects::value_or_end;
    } else if (rest.starts_with(',')) {
      context.expects = context.in_object ? Expects::key : Expects::value;
      context.comma = std::exchange(context.token, skip_whitespace(context.token + 1));
    } else {
      context.expects = Expects::comma_or_end;
    }
    return context;
  }

  static JsonValue of_kind(JsonValue::Kind kind) {
    JsonValue value;
    value.kind = kind;
    return value;
  }

  JsonValue& add(JsonValue value, std::size_t offset) {
    if (++count_ > max_values_) {
      fail(ErrorKind::limit, offset,
           std::string("the text has more values than ")
               .append(std::to_string(max_values_))
               .append(", the limit"));
    }
    if (count_ % kBlock == 1) take_memory(kBlock * kBytesOfValue, "the values of JSON");
    value.offset = offset;
    last_ = Last::value;
    if (open_.empty()) return root_ = std::move(value);
    JsonValue& parent = *open_.back();
    if (parent.kind == JsonValue::Kind::array) {
      return parent.items.emplace_back(std::move(value));
    }
    JsonValue& member = parent.members.back().value;
    value.key_offset = member.key_offset;
    return member = std::move(value);
  }

  bool scalar(JsonValue value, std::size_t length) {
    const std::size_t start = next_token().token;
    end_ = start + length;
    add(std::move(value), start);
    return true;
  }

  bool number(double value, bool is_integer) {
    const std::size_t start = next_token().token;
    JsonValue result = of_kind(JsonValue::Kind::number);
    result.is_integer = is_integer;
    // nlohmann's lexer reads -0 as the integer 0.
    result.number = text_[start] == '-' ? -std::abs(value) : value;
    return scalar(std::move(result), number_end(text_, start) - start);
  }

  bool open(JsonValue::Kind kind) {
    const std::size_t start = next_token().token;
    if (open_.size() == kMaxJsonDepth) {
      // The error has no JSON pointer, because at this depth the pointer would be extremely long.
      throw Error(ErrorKind::limit,
                  document_.at(start, "", "arrays and objects are nested more than 256 deep"));
    }
    // New values are only added to the innermost open one, so the other pointers remain valid.
    open_.push_back(&add(of_kind(kind), start));
    end_ = start + 1;
    last_ = Last::open;
    return true;
  }

  bool close() {
    end_ = next_token().token + 1;
    open_.pop_back();
    last_ = Last::value;
    return true;
  }

  void make_keys_unique(JsonValue& object) {
    const RepeatedMembers repeated = repeated_members(object);
    const std::vector<std::size_t>& outdone = repeated.outdone;
    if (outdone.empty()) return;
    if (policy_ == RepeatedKeys::are_refused) {
      fail({repeated.first, "the key " + in_quotes(repeated.key) + " occurs twice in this object"});
    }
    note_outdone(object, outdone);
    std::erase_if(object.members, [&](const JsonMember& member) {
      return std::binary_search(outdone.begin(), outdone.end(), member.value.key_offset);
    });
  }

  /// Records an object's duplicate keys. Makes a pointer, which may be as long as the text, only
  /// for the first duplicate known so far. An enclosing object ends later but may have an earlier
  /// one.
  void note_outdone(const JsonValue& object, const std::vector<std::size_t>& offsets) {
    const bool is_first = outdone_keys_.count == 0 || offsets.front() < outdone_keys_.offset;
    outdone_keys_.count += offsets.size();
    if (!is_first) return;
    const auto first = std::ranges::find(object.members, offsets.front(),
                                         [](const JsonMember& m) { return m.value.key_offset; });
    outdone_keys_.offset = offsets.front();
    outdone_keys_.pointer = child(pointer(), first->key);
  }

  /// Returns the pointer to the innermost open value, or to the member whose key was read last.
  [[nodiscard]] std::string pointer() const {
    std::string out;
    for (const JsonValue* value : open_) {
      const bool is_innermost = value == open_.back();
      if (value->kind == JsonValue::Kind::array) {
        if (!is_innermost) out = child(out, value->items.size() - 1);
      } else if (!is_innermost || last_ == Last::key) {
        out = child(out, value->members.back().key);
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
  JsonValue& root_;
  std::size_t max_values_;
  RepeatedKeys policy_;
  OutdoneKeys& outdone_keys_;
  std::vector<JsonValue*> open_;  // from the root to the innermost
  std::size_t end_ = 0;           // end of the last token
  Last last_ = Last::open;
  std::size_t count_ = 0;
};

}  // namespace

JsonDocument::JsonDocument(std::string_view text, std::string file, std::size_t max_values,
                           RepeatedKeys repeated)
    : text_(text), file_(std::move(file)) {
  if (text.size() > kMaxJsonSize) {
    throw Error(ErrorKind::limit, file_, "the JSON text is larger than 1 GiB");
  }
  std::string_view content = text;
  if (content.starts_with(kByteOrderMark)) content.remove_prefix(kByteOrderMark.size());
  if (content.find_first_not_of(kWhitespace) == std::string_view::npos) {
    throw Error(ErrorKind::invalid_scene, file_, "is empty");
  }
  TreeBuilder builder(*this, text, root_, max_values, repeated, outdone_keys_);
  nlohmann::json::sax_parse(text.data(), text.data() + text.size(), &builder);
  builder.require_end();
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

}  // namespace microtrace::io

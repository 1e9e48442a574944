#include "io/json/reader.hpp"

#include "base/text/nearest_name.hpp"
#include "base/text/printable.hpp"

#include <algorithm>
#include <cmath>

namespace microtrace::io {
namespace {

using Kind = JsonValue::Kind;

std::string_view name_of(Kind kind) {
  switch (kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return "true or false";
    case Kind::number:
      return "a number";
    case Kind::string:
      return "a string";
    case Kind::array:
      return "an array";
    case Kind::object:
      return "an object";
  }
  return {};
}

}  // namespace

void JsonReader::fail(std::string message, ErrorKind kind) const {
  throw Error(kind, document_->at(value_->offset, pointer_, std::move(message)));
}

void JsonReader::fail(std::string message, const Error& cause) const {
  document_->fail(value_->offset, pointer_, std::move(message), cause);
}

void JsonReader::fail_unknown(std::string_view what, std::string_view name,
                              const std::vector<std::string_view>& known) const {
  std::string message = "unknown ";
  message.append(what).append(" ").append(in_quotes(name));
  fail(message.append(suggestion(name, known)));
}

void JsonReader::require(const std::optional<BrokenRule>& rule) const {
  if (!rule) return;
  if (const auto field = find(rule->field)) {
    const JsonValue& found = field->value();
    const bool underflows = found.number() != 0 && static_cast<float>(found.number()) == 0;
    std::string message = rule->message;
    if (underflows) message += " once rounded to float32";
    field->fail(std::move(message), rule->kind);
  }
  fail(rule->field.empty() ? rule->message
                           : std::string(rule->field).append(" ").append(rule->message),
       rule->kind);
}

void JsonReader::require_kind(Kind kind) const {
  if (value_->kind() == kind) return;
  std::string message = "must be ";
  message.append(name_of(kind)).append(", is ");
  if (value_->kind() == Kind::boolean) {
    fail(message.append(value_->boolean() ? "true" : "false"));
  }
  fail(message.append(name_of(value_->kind())));
}

void JsonReader::require_object() const {
  require_kind(Kind::object);
}

void JsonReader::require_object(std::initializer_list<std::string_view> known) const {
  require_object();
  for (const auto& [key, value] : value_->members()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    std::string message = "unknown key ";
    message.append(in_quotes(key)).append(suggestion(key, {known.begin(), known.size()}));
    throw Error(ErrorKind::invalid_scene,
                document_->at(value.key_offset, pointer_, std::move(message)));
  }
}

std::optional<JsonReader> JsonReader::find(std::string_view key) const {
  const JsonValue* found = value_->find(key);
  if (found == nullptr) return {};
  return JsonReader(*document_, *found, child(pointer_, key));
}

JsonReader JsonReader::member(std::string_view key) const {
  require_object();
  if (auto found = find(key)) return *std::move(found);
  fail(std::string("lacks the required member ").append(in_quotes(key)));
}

std::vector<std::pair<std::string, JsonReader>> JsonReader::members() const {
  require_object();
  std::vector<std::pair<std::string, JsonReader>> out;
  out.reserve(value_->members().size());
  for (const auto& [key, value] : value_->members()) {
    out.emplace_back(key, JsonReader(*document_, value, child(pointer_, key)));
  }
  return out;
}

std::vector<JsonReader> JsonReader::items(std::optional<std::size_t> count) const {
  require_kind(Kind::array);
  const std::size_t size = value_->items().size();
  if (count && size != *count) {
    std::string message = "must have ";
    message.append(std::to_string(*count)).append(" items, has ").append(std::to_string(size));
    fail(std::move(message));
  }
  std::vector<JsonReader> out;
  out.reserve(size);
  for (std::size_t i = 0; i < size; ++i) {
    out.push_back(JsonReader(*document_, value_->items()[i], child(pointer_, i)));
  }
  return out;
}

std::string JsonReader::string() const {
  require_kind(Kind::string);
  return value_->string();
}

std::string JsonReader::name() const {
  std::string out = string();
  if (out.empty()) fail("must not be empty");
  return out;
}

double JsonReader::number() const {
  require_kind(Kind::number);
  if (std::abs(value_->number()) < kFloat32Bound) return value_->number();
  std::string message = "must be finite in float32, where the largest number is about 3.4e38, is ";
  fail(message.append(decimal(value_->number())));
}

std::uint64_t JsonReader::count() const {
  require_kind(Kind::number);
  const double number = value_->number();
  if (number >= 0 && number <= 0x1p53 && number == std::floor(number)) {
    return static_cast<std::uint64_t>(number);
  }
  fail(std::string("must be a whole number and not negative, is ").append(decimal(number)));
}

DVec3 JsonReader::vector() const {
  const std::vector<JsonReader> xyz = items(3);
  return {xyz[0].number(), xyz[1].number(), xyz[2].number()};
}

}  // namespace microtrace::io

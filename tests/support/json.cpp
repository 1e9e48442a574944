#include "support/json.hpp"

#include <algorithm>
#include <ostream>
#include <utility>

#include <nlohmann/json.hpp>

namespace microtrace::tests {

Json::Json() : scalar_("null") {}
Json::Json(bool value) : scalar_(value ? "true" : "false") {}
Json::Json(int value) : scalar_(std::to_string(value)) {}
Json::Json(unsigned value) : scalar_(std::to_string(value)) {}
Json::Json(long value) : scalar_(std::to_string(value)) {}
Json::Json(unsigned long value) : scalar_(std::to_string(value)) {}
Json::Json(double value) : scalar_(nlohmann::json(value).dump()) {}
Json::Json(const char* value) : scalar_(nlohmann::json(value).dump()) {}
Json::Json(const std::string& value) : scalar_(nlohmann::json(value).dump()) {}
Json::Json(Kind kind) : kind_(kind) {}

Json::Json(std::initializer_list<Json> values) : kind_(Kind::array), elements_(values) {
  const auto is_member = [](const Json& value) {
    return value.kind_ == Kind::array && value.elements_.size() == 2 &&
           value.elements_[0].scalar_.starts_with('"');
  };
  if (!std::ranges::all_of(elements_, is_member)) return;
  kind_ = Kind::object;
  elements_.clear();
  for (const Json& member : values) {
    const auto key = nlohmann::json::parse(member.elements_[0].scalar_).get<std::string>();
    members_[key] = member.elements_[1];
  }
}

Json::Json(const Json&) = default;
Json::Json(Json&&) noexcept = default;
Json& Json::operator=(const Json&) = default;
Json& Json::operator=(Json&&) noexcept = default;
Json::~Json() = default;

Json Json::array(std::initializer_list<Json> values) {
  Json result(Kind::array);
  result.elements_ = values;
  return result;
}

Json Json::object() {
  return Json(Kind::object);
}

Json Json::repeated(std::size_t count, const Json& value) {
  Json result(Kind::array);
  result.elements_.assign(count, value);
  return result;
}

Json Json::parse(std::string_view text) {
  const auto converted = [](const auto& self, const nlohmann::json& value) -> Json {
    Json result;
    if (value.is_object()) {
      result.kind_ = Kind::object;
      for (const auto& [key, member] : value.items()) result[key] = self(self, member);
    } else if (value.is_array()) {
      result.kind_ = Kind::array;
      for (const nlohmann::json& element : value) result.push_back(self(self, element));
    } else {
      result.scalar_ = value.dump();
    }
    return result;
  };
  return converted(converted, nlohmann::json::parse(text));
}

Json& Json::operator[](std::size_t index) {
  if (is_null()) kind_ = Kind::array;
  if (index >= elements_.size()) elements_.resize(index + 1);
  return elements_[index];
}

Json& Json::operator[](std::string_view key) {
  if (is_null()) kind_ = Kind::object;
  return members_[std::string(key)];
}

void Json::push_back(const Json& value) {
  if (is_null()) kind_ = Kind::array;
  elements_.push_back(value);
}

void Json::erase(std::size_t index) {
  elements_.erase(elements_.begin() + static_cast<std::ptrdiff_t>(index));
}

void Json::erase(std::string_view key) {
  members_.erase(std::string(key));
}

void Json::update(const Json& other) {
  for (const auto& [key, member] : other.members_) (*this)[key] = member;
}

void Json::merge_patch(const Json& patch) {
  if (patch.kind_ != Kind::object) {
    *this = patch;
    return;
  }
  if (kind_ != Kind::object) *this = object();
  for (const auto& [key, member] : patch.members_) {
    if (member.is_null())
      erase(key);
    else
      (*this)[key].merge_patch(member);
  }
}

bool Json::contains(std::string_view key) const {
  return members_.contains(key);
}

std::size_t Json::size() const {
  return kind_ == Kind::object ? members_.size() : elements_.size();
}

const std::map<std::string, Json, std::less<>>& Json::members() const {
  return members_;
}

std::vector<Json>::iterator Json::begin() {
  return elements_.begin();
}

std::vector<Json>::iterator Json::end() {
  return elements_.end();
}

std::size_t Json::to_size() const {
  return std::stoul(scalar_);
}

bool Json::operator==(const Json& other) const = default;

std::string Json::dump(int indentation) const {
  std::string text;
  append_to(text);
  return indentation < 0 ? text : nlohmann::json::parse(text).dump(indentation);
}

std::ostream& operator<<(std::ostream& out, const Json& json) {
  return out << json.dump();
}

bool Json::is_null() const {
  return kind_ == Kind::scalar && scalar_ == "null";
}

void Json::append_to(std::string& text) const {
  if (kind_ == Kind::scalar) {
    text += scalar_;
    return;
  }
  const char* separator = "";
  text += kind_ == Kind::object ? '{' : '[';
  for (const Json& element : elements_) {
    text += std::exchange(separator, ",");
    element.append_to(text);
  }
  for (const auto& [key, member] : members_) {
    text += std::exchange(separator, ",") + nlohmann::json(key).dump() + ':';
    member.append_to(text);
  }
  text += kind_ == Kind::object ? '}' : ']';
}

}  // namespace microtrace::tests

#include "io/gltf/check/schema/schema.hpp"

#include "base/text/printable.hpp"
#include "io/gltf/check/schema/attribute_names.hpp"
#include "io/gltf/check/schema/repeated_items.hpp"
#include "io/gltf/check/schema/rule_text.hpp"
#include "io/gltf/extensions/extensions.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace microtrace::io::gltf {
namespace {

using Kind = JsonValue::Kind;

class Checker {
 public:
  explicit Checker(Asset& asset) : asset_(asset) {}

  void object(const Element& at, std::span<const Rule> rules, Place place) {
    require(at, at.value->kind() == Kind::object, "must be an object");
    for (const Rule& rule : rules) {
      if (rule.required && at.value->find(rule.key) == nullptr) {
        asset_.fail(at, "lacks the required property " + in_quotes(rule.key));
      }
    }
    std::vector<std::string> dropped;
    for (const JsonMember& member : at.value->members()) {
      const Element element{&member.value, child(at.pointer, member.key)};
      const auto rule = std::ranges::find(rules, member.key, &Rule::key);
      const bool is_known =
          rule != rules.end() || member.key == "extensions" || member.key == "name";
      const bool is_required = rule != rules.end() && rule->required;
      if (is_known && !is_required && is_null(element)) {
        dropped.push_back(member.key);
      } else if (rule != rules.end()) {
        if (!property(element, *rule)) dropped.push_back(member.key);
      } else if (member.key == "extensions") {
        extensions(element, place);
      } else if (member.key == "name") {
        require(element, member.value.kind() == Kind::string, "must be a string");
      } else if (member.key != "extras") {
        asset_.warn(element, "is not a glTF 2.0 property of this object; it is ignored");
      }
    }
    if (!dropped.empty()) asset_.drop(at, {dropped.begin(), dropped.end()});
  }

 private:
  void require(const Element& at, bool holds, const char* message) const {
    if (!holds) asset_.fail(at, message);
  }

  /// If the value is null, warns and returns true. glTF 2.0 forbids null, but some exporters write
  /// it for absent values.
  bool is_null(const Element& at) const {
    if (at.value->kind() != Kind::null) return false;
    asset_.tolerate(at, "is null, which glTF 2.0 forbids; it is treated as absent");
    return true;
  }

  /// Does the same for an optional array with null among its items, which JavaScript writes for
  /// NaN.
  [[nodiscard]] bool has_null(const Element& at, const Rule& rule) const {
    const std::vector<JsonValue>& items = at.value->items();
    const auto null = std::ranges::find(items, Kind::null, &JsonValue::kind);
    if (null == items.end() || rule.required) return false;
    asset_.tolerate(at.item(static_cast<std::size_t>(null - items.begin())),
                    "is null, which glTF 2.0 forbids; the whole property is treated as absent");
    return true;
  }

  /// Returns false if the value must be dropped.
  bool property(const Element& at, const Rule& rule) {
    switch (rule.form) {
      case Form::boolean:
        require(at, at.value->kind() == Kind::boolean, "must be true or false");
        break;
      case Form::integer:
      case Form::number:
        return number(at, rule);
      case Form::string:
        return string(at, rule);
      case Form::index:
        index(at, rule);
        break;
      case Form::indices:
        array(at, rule, [&](const Element& item) { index(item, rule); });
        tolerate_repeated(asset_, at, &JsonValue::number);
        break;
      case Form::numbers:
        if (has_null(at, rule)) return false;
        array(at, rule, [&](const Element& item) { number(item, rule); });
        break;
      case Form::strings:
        array(at, rule, [&](const Element& item) { string(item, rule); });
        tolerate_repeated(asset_, at, &JsonValue::string);
        break;
      case Form::object:
        object(at, rule.members, rule.place);
        break;
      case Form::objects:
        array(at, rule, [&](const Element& item) { object(item, rule.members, rule.place); });
        break;
      case Form::attributes:
      case Form::instance_attributes:
      case Form::draco_attributes:
        attributes(at, rule);
        break;
      case Form::targets:
        array(at, rule, [&](const Element& item) { attributes(item, rule); });
        break;
      case Form::anything:
        break;
    }
    return true;
  }

  bool number(const Element& at, const Rule& rule) const {
    // An unusable number, with which readers leave out the camera.
    if (at.value->kind() == Kind::null && rule.required && rule.repair == Repair::keep) {
      asset_.tolerate(at, "is null, which glTF 2.0 forbids; " + text_of(rule.min) + " is used");
      asset_.set(at, rule.min);
      return true;
    }
    const double number = at.value->number();
    const bool integral = std::trunc(number) == number && std::abs(number) <= 0x1p53;
    const bool integer = rule.form == Form::integer;
    const std::string what = integer ? "must be an integer" : "must be a number";
    if (at.value->kind() != Kind::number || (integer && !integral)) asset_.fail(at, what);
    if (number < rule.min || number > rule.max || (rule.above_min && number == rule.min)) {
      return repaired(at, rule, what + range_of(rule) + ", is " + text_of(number));
    }
    if (rule.values.empty() || std::ranges::find(rule.values, number) != rule.values.end()) {
      return true;
    }
    return unknown(at, rule, text_of(number));
  }

  /// Handles a number that is out of range. Returns false if it must be dropped.
  bool repaired(const Element& at, const Rule& rule, const std::string& message) const {
    switch (rule.repair) {
      case Repair::none:
        asset_.fail(at, message);
      case Repair::clamp: {
        asset_.tolerate(at, message + "; the nearest number in range is used");
        const double least = rule.above_min ? std::nextafter(rule.min, rule.min + 1) : rule.min;
        asset_.set(at, std::clamp(at.value->number(), least, rule.max));
        return true;
      }
      case Repair::drop:
        asset_.tolerate(at, message + "; it is ignored");
        return false;
      case Repair::keep:
        asset_.tolerate(at, message);
        return true;
    }
    return true;
  }

  bool string(const Element& at, const Rule& rule) const {
    const std::string& string = at.value->string();
    require(at, at.value->kind() == Kind::string, "must be a string");
    if (rule.strings.empty() || std::ranges::find(rule.strings, string) != rule.strings.end()) {
      return true;
    }
    return unknown(at, rule, in_quotes(string));
  }

  /// Handles an unknown value, which an extension may define. Returns false if it must be dropped.
  bool unknown(const Element& at, const Rule& rule, const std::string& found) const {
    const std::string message = "must be one of " + values_of(rule) + ", is " + found;
    if (rule.repair == Repair::none) asset_.fail(at, message);
    asset_.warn(at, message + "; it is ignored");
    return rule.repair == Repair::keep;
  }

  void index(const Element& at, const Rule& rule) {
    const double number = at.value->number();
    const bool in_extension = rule.target.starts_with('/');
    const std::string array = (in_extension ? "" : "/") + std::string(rule.target);
    if (at.value->kind() != Kind::number || std::trunc(number) != number || number < 0) {
      asset_.fail(at, "must be an integer of at least 0, an index into " + array);
    }
    const JsonValue* items = asset_.find(array);
    if (items == nullptr && in_extension) {
      asset_.tolerate(
          at, "is an index into " + array + ", which is absent; the extension is ignored here");
      lacks_other_part_ = true;
      return;
    }
    const std::size_t size = items != nullptr ? items->items().size() : 0;
    if (number >= static_cast<double>(size)) {
      asset_.fail(at, "is " + text_of(number) + ", but " + array + " has only " +
                          std::to_string(size) + " items, counted from 0");
    }
  }

  template <typename CheckItem>
  void array(const Element& at, const Rule& rule, CheckItem&& check) {
    require(at, at.value->kind() == Kind::array, "must be an array");
    const std::size_t size = at.value->items().size();
    if (size < rule.fewest || size > rule.most) {
      asset_.fail(at, "must have " + std::string(size < rule.fewest ? "at least " : "at most ") +
                          std::to_string(size < rule.fewest ? rule.fewest : rule.most) +
                          " items, has " + std::to_string(size));
    }
    if (size == 0) asset_.tolerate(at, "is empty, which glTF 2.0 forbids; leave it out instead");
    for (std::size_t i = 0; i < size; ++i) check(at.item(i));
  }

  /// True for the attributes that extensions such as KHR_gaussian_splatting define, whose names
  /// begin with the extension's and a colon.
  [[nodiscard]] bool is_of_extension(std::string_view attribute) const {
    const std::size_t colon = attribute.find(':');
    return colon != std::string_view::npos && asset_.uses(attribute.substr(0, colon));
  }

  void attributes(const Element& at, const Rule& rule) {
    require(at, at.value->kind() == Kind::object, "must be an object");
    if (at.value->members().empty() && rule.form != Form::attributes) {
      asset_.tolerate(at, "is empty, which glTF 2.0 forbids");
    }
    const bool of_instances = rule.form == Form::instance_attributes;
    std::vector<std::string> dropped;
    for (const JsonMember& member : at.value->members()) {
      const Element attribute{&member.value, child(at.pointer, member.key)};
      const bool has_name =
          of_instances ? is_instance_attribute_name(member.key) : is_attribute_name(member.key);
      if (!has_name) {
        if (!is_of_extension(member.key)) {
          asset_.tolerate(
              attribute,
              "is not a glTF 2.0 attribute, and names of custom attributes begin with _; it "
              "is ignored");
        }
        dropped.push_back(member.key);
      } else if (is_null(attribute)) {
        dropped.push_back(member.key);
      } else if (rule.form == Form::draco_attributes) {
        number(attribute, {.key = rule.key, .form = Form::integer, .min = 0});
      } else {
        index(attribute, rule);
      }
    }
    if (!dropped.empty()) asset_.drop(at, {dropped.begin(), dropped.end()});
  }

  void extensions(const Element& at, Place place) {
    require(at, at.value->kind() == Kind::object, "must be an object");
    std::vector<std::string> dropped;
    for (const JsonMember& member : at.value->members()) {
      const Element extension{&member.value, child(at.pointer, member.key)};
      if (is_null(extension)) {
        dropped.push_back(member.key);
        continue;
      }
      require(extension, member.value.kind() == Kind::object, "must be an object");
      if (!this->extension(extension, member.key, place)) dropped.push_back(member.key);
    }
    if (!dropped.empty()) asset_.drop(at, {dropped.begin(), dropped.end()});
  }

  /// Returns false if the extension must be dropped.
  bool extension(const Element& at, const std::string& name, Place place) {
    if (!asset_.uses(name)) {
      asset_.tolerate(at, "is not declared in extensionsUsed; the extension is ignored here");
      return false;
    }
    const Extension* known = find_extension(name);
    if (known == nullptr || known->object_in(Place::anywhere) != nullptr) return true;
    const ExtensionObject* here = known->object_in(place);
    if (here == nullptr) {
      asset_.tolerate(at,
                      "is an extension that does not belong in this object; it is ignored here");
      return false;
    }
    const bool outer_lacks = std::exchange(lacks_other_part_, false);
    object(at, here->rules, Place::other);
    return !std::exchange(lacks_other_part_, outer_lacks);
  }

  Asset& asset_;
  bool lacks_other_part_ = false;  // true if the current extension object refers to an absent array
};

}  // namespace

void check_schema(Asset& asset) {
  Checker(asset).object(asset.root(), gltf_rules(), Place::root);
}

}  // namespace microtrace::io::gltf

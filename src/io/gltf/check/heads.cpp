#include "io/gltf/check/heads.hpp"

#include "io/gltf/document/properties.hpp"

#include <algorithm>

namespace microtrace::io::gltf {
namespace {

std::size_t size_or_zero(const JsonValue& object, std::string_view key) {
  return index_in(object, key).value_or(0);
}

AccessorHead head_of(const Asset& asset, const JsonValue& accessor) {
  AccessorHead head;
  if (const JsonValue* type = accessor.find("type")) head.format.type = type->string();
  head.format.component_type = static_cast<int>(size_or_zero(accessor, "componentType"));
  const JsonValue* normalized = accessor.find("normalized");
  head.format.normalized = normalized != nullptr && normalized->boolean();
  head.count = accessor.find("count")->number();
  head.has_bounds = accessor.find("min") != nullptr && accessor.find("max") != nullptr;
  head.offset = size_or_zero(accessor, "byteOffset");
  if (accessor.find("bufferView") == nullptr) return head;
  head.view = size_or_zero(accessor, "bufferView");
  const JsonValue& view = asset.array("bufferViews")[*head.view];
  head.stride = size_or_zero(view, "byteStride");
  head.start = size_or_zero(view, "byteOffset") + head.offset;
  return head;
}

const char* name_of(Purpose purpose) {
  switch (purpose) {
    case Purpose::none:
      return "nothing";
    case Purpose::vertex_attribute:
      return "vertex attributes";
    case Purpose::vertex_indices:
      return "vertex indices";
    case Purpose::inverse_bind_matrices:
      return "inverse bind matrices";
    case Purpose::animation_input:
      return "animation times";
    case Purpose::animation_output:
      return "animated values";
    case Purpose::image:
      return "an image";
  }
  return "";
}

/// Returns true if the buffer views for this purpose may have a target.
bool is_vertex_data(Purpose purpose) {
  return purpose == Purpose::vertex_attribute || purpose == Purpose::vertex_indices;
}

bool shares(Purpose a, Purpose b) {
  const auto group = [](Purpose p) {
    return p == Purpose::animation_output ? Purpose::animation_input : p;
  };
  return group(a) == group(b);
}

}  // namespace

std::string Format::text() const {
  std::string result = type.empty() ? "an unknown type" : std::string(type);
  result += component_type == 0 ? " of an unknown component type"
                                : " of componentType " + std::to_string(component_type);
  return normalized ? result + ", normalized" : result;
}

bool is_one_of(const Format& format, std::initializer_list<Format> formats) {
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

AccessorHeads::AccessorHeads(Asset& asset) : asset_(asset) {
  for (const JsonValue& accessor : asset.array("accessors")) {
    heads_.push_back(head_of(asset, accessor));
  }
  purposes_.resize(heads_.size());
  view_purposes_.resize(asset.array("bufferViews").size());
  view_accessors_.resize(view_purposes_.size());
}

void AccessorHeads::use(const Element& at, Purpose purpose) {
  const auto index = index_from(*at.value);
  Purpose& known = purposes_[index];
  const bool first_use = known == Purpose::none;
  if (first_use) {
    known = purpose;
  } else if (known != purpose) {
    asset_.tolerate(at, std::string("names an accessor for ") + name_of(purpose) +
                            " that is also used for " + name_of(known));
  }
  const AccessorHead& head = heads_[index];
  if (!head.view) return;
  use_view(at, *head.view, purpose);
  if (purpose != Purpose::vertex_attribute || head.stride != 0) return;
  std::size_t& other = view_accessors_[*head.view];
  if (other == 0) other = index + 1;
  if (other != index + 1) {
    asset_.tolerate(
        at, "shares its bufferView with another vertex attribute, which requires a byteStride");
  }
}

void AccessorHeads::use_view(const Element& at, std::size_t view, Purpose purpose) {
  const JsonValue& json = asset_.array("bufferViews")[view];
  Purpose& known = view_purposes_[view];
  if (known == Purpose::none) {
    known = purpose;
    if (purpose != Purpose::vertex_attribute && json.find("byteStride") != nullptr) {
      asset_.tolerate(at, "uses a bufferView with byteStride, which is for vertex attributes only");
    }
    const double target = purpose == Purpose::vertex_attribute ? 34962 : 34963;
    const JsonValue* given = json.find("target");
    if (given != nullptr && (!is_vertex_data(purpose) || given->number() != target)) {
      asset_.tolerate(at, std::string("uses a bufferView for ") + name_of(purpose) +
                              " whose target is different");
    }
  } else if (!shares(known, purpose)) {
    asset_.tolerate(at, std::string("uses a bufferView for ") + name_of(purpose) +
                            " that is also used for " + name_of(known));
  }
}

}  // namespace microtrace::io::gltf

#include "io/gltf/check/semantics.hpp"
#include "io/gltf/check/texture_infos.hpp"
#include "io/gltf/document/element_types.hpp"
#include "io/gltf/document/properties.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace microtrace::io::gltf {
namespace {

struct Semantic {
  std::string_view name;  ///< without the set number
  std::size_t set = 0;
};

Semantic split(std::string_view name) {
  const std::size_t last = name.rfind('_');
  if (name.starts_with('_') || last == std::string_view::npos) return {name};
  std::size_t set = 0;
  for (const char digit : name.substr(last + 1)) {
    set = std::min<std::size_t>(set * 10 + static_cast<std::size_t>(digit - '0'), 1U << 20);
  }
  return {name.substr(0, last), set};
}

bool is_one_of(int value, std::initializer_list<int> values) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

/// Returns true if glTF 2.0 allows the format for the attribute: section 3.7.2.1, or 3.7.2.2 for
/// morph targets.
bool is_standard(std::string_view name, const Format& f, bool of_target) {
  const bool is_float = f.component_type == kFloat32 && !f.normalized;
  const bool is_unit = f.normalized && is_one_of(f.component_type, {kUint8, kUint16});
  const bool is_signed_unit =
      of_target && f.normalized && is_one_of(f.component_type, {kInt8, kInt16});
  const bool is_fraction = is_float || is_unit || is_signed_unit;
  if (name == "POSITION" || name == "NORMAL") return f.type == "VEC3" && is_float;
  if (name == "TANGENT") return f.type == (of_target ? "VEC3" : "VEC4") && is_float;
  if (name == "TEXCOORD") return f.type == "VEC2" && is_fraction;
  if (name == "COLOR") return (f.type == "VEC3" || f.type == "VEC4") && is_fraction;
  if (name == "WEIGHTS") return f.type == "VEC4" && (is_float || is_unit);
  if (name == "JOINTS") {
    return f.type == "VEC4" && !f.normalized && is_one_of(f.component_type, {kUint8, kUint16});
  }
  // An application-specific attribute has any known format but this one.
  return !f.type.empty() && f.component_type != kUint32;
}

/// Returns true for the additional formats of KHR_mesh_quantization.
bool is_quantized(std::string_view name, const Format& f, bool of_target) {
  const bool is_signed = is_one_of(f.component_type, {kInt8, kInt16});
  const bool is_short = is_signed || is_one_of(f.component_type, {kUint8, kUint16});
  if (name == "POSITION") return f.type == "VEC3" && (of_target ? is_signed : is_short);
  if (name == "NORMAL") return f.type == "VEC3" && is_signed && f.normalized;
  if (name == "TANGENT") {
    return f.type == (of_target ? "VEC3" : "VEC4") && is_signed && f.normalized;
  }
  return name == "TEXCOORD" && f.type == "VEC2" && is_short;
}

std::size_t target_count(const JsonValue& primitive) {
  const JsonValue* targets = primitive.find("targets");
  return targets != nullptr ? targets->items().size() : 0;
}

class MeshCheck {
 public:
  MeshCheck(Asset& asset, AccessorHeads& accessors)
      : asset_(asset),
        accessors_(accessors),
        quantized_(asset.uses("KHR_mesh_quantization")),
        infos_(texture_infos(asset)) {}

  void mesh(const Element& at) {
    const Element primitives = at.member("primitives");
    std::size_t targets = 0;
    for (std::size_t k = 0; k < primitives.value->items().size(); ++k) {
      const Element primitive = primitives.item(k);
      const std::size_t count = target_count(*primitive.value);
      if (k == 0) targets = count;
      if (count != targets) {
        asset_.tolerate(primitive, "has " + std::to_string(count) +
                                       " morph targets, but the mesh's first primitive has " +
                                       std::to_string(targets));
      }
      this->primitive(primitive);
    }
    check_weights(asset_, at, morph_target_count(*at.value));
  }

 private:
  void primitive(const Element& at) {
    const Element attributes = at.member("attributes");
    same_counts(attributes);
    sets(attributes);
    this->attributes(attributes, false);
    if (at.value->find("indices") != nullptr) indices(at.member("indices"));
    const Element targets = at.member("targets");
    for (std::size_t i = 0; i < target_count(*at.value); ++i) target(targets.item(i), attributes);
    material(at, attributes);
  }

  /// Drops attributes whose count differs from that of the positions.
  void same_counts(const Element& at) const {
    if (at.value->members().empty()) return;
    const JsonValue* position = at.value->find("POSITION");
    const std::string first = position != nullptr ? "POSITION" : at.value->members().front().key;
    const double count = accessors_[*at.member(first).value].count;
    std::vector<std::string> dropped;
    for (const JsonMember& member : at.value->members()) {
      const double own = accessors_[member.value].count;
      if (own == count) continue;
      asset_.tolerate(at.member(member.key), "has " + text(own) + " elements, but " + first +
                                                 " has " + text(count) + "; it is ignored");
      dropped.push_back(member.key);
    }
    if (!dropped.empty()) asset_.drop(at, {dropped.begin(), dropped.end()});
  }

  /// Requires that set numbers are consecutive from 0, and that there are as many sets of JOINTS as
  /// of WEIGHTS.
  void sets(const Element& at) const {
    std::size_t joints = 0, weights = 0;
    for (const std::string_view name : {"TEXCOORD", "COLOR", "JOINTS", "WEIGHTS"}) {
      std::size_t count = 0, end = 0;
      for (const JsonMember& member : at.value->members()) {
        const Semantic semantic = split(member.key);
        if (semantic.name != name) continue;
        ++count;
        end = std::max(end, semantic.set + 1);
      }
      if (count != end) {
        asset_.tolerate(
            at, "has sets of " + std::string(name) + " that are not numbered consecutively from 0");
      }
      (name == "JOINTS" ? joints : weights) = count;
    }
    if (joints != weights) {
      asset_.tolerate(at, "has " + std::to_string(joints) + " sets of JOINTS, but " +
                              std::to_string(weights) + " of WEIGHTS; each needs the other");
    }
  }

  void attributes(const Element& at, bool of_target) {
    std::vector<std::string> dropped;
    for (const JsonMember& member : at.value->members()) {
      const Element attribute{&member.value, child(at.pointer, member.key)};
      accessors_.use(attribute, Purpose::vertex_attribute);
      if (!format(attribute, split(member.key).name, of_target)) {
        dropped.push_back(member.key);
        // Joints without weights, and weights without joints, are useless.
        if (member.key.starts_with("JOINTS_")) dropped.push_back("WEIGHTS_" + member.key.substr(7));
        if (member.key.starts_with("WEIGHTS_")) dropped.push_back("JOINTS_" + member.key.substr(8));
        continue;
      }
      alignment(attribute);
      if (member.key == "POSITION" && !accessors_[member.value].has_bounds) {
        asset_.tolerate(asset_.element("accessors", index_from(member.value)),
                        "holds positions without min and max, which glTF 2.0 requires");
      }
    }
    if (!dropped.empty()) asset_.drop(at, {dropped.begin(), dropped.end()});
  }

  /// Returns false if the attribute's format can't be read.
  [[nodiscard]] bool format(const Element& at, std::string_view name, bool of_target) const {
    const Format& format = accessors_[*at.value].format;
    if (is_standard(name, format, of_target)) return true;
    if (is_quantized(name, format, of_target)) {
      if (!quantized_) {
        asset_.tolerate(at, "is quantized, which needs extension KHR_mesh_quantization");
      }
      return true;
    }
    asset_.tolerate(at, "refers to an accessor of " + format.text() +
                            ", which glTF 2.0 does not allow for this attribute; it is ignored");
    return false;
  }

  void alignment(const Element& at) const {
    const AccessorHead& head = accessors_[*at.value];
    if (!head.view) return;
    const std::size_t stride =
        head.stride != 0 ? head.stride
                         : element_size(element_type(head.format.type), head.format.component_type);
    if (head.offset % 4 != 0 || head.start % 4 != 0 || stride % 4 != 0) {
      asset_.tolerate(at, "has vertices that do not all start at a multiple of 4 bytes");
    }
  }

  void indices(const Element& at) {
    accessors_.use(at, Purpose::vertex_indices);
    const Format& format = accessors_[*at.value].format;
    if (io::gltf::is_one_of(format, {{"SCALAR", kUint8}, {"SCALAR", kUint16}, {"SCALAR", kUint32}}))
      return;
    asset_.fail(at, "refers to an accessor of " + format.text() +
                        "; indices must be SCALAR of componentType 5121, 5123 or 5125");
  }

  void target(const Element& at, const Element& base) {
    std::vector<std::string> dropped;
    for (const JsonMember& member : at.value->members()) {
      const Element attribute{&member.value, child(at.pointer, member.key)};
      const std::string wrong = why_not_morphed(member, base.value->find(member.key));
      if (wrong.empty()) continue;
      asset_.tolerate(attribute, wrong + "; it is ignored");
      dropped.push_back(member.key);
    }
    if (!dropped.empty()) asset_.drop(at, {dropped.begin(), dropped.end()});
    attributes(at, true);
  }

  /// Returns the reason why a morph target's attribute does not fit the primitive's, or an empty
  /// text.
  [[nodiscard]] std::string why_not_morphed(const JsonMember& target, const JsonValue* base) const {
    if (target.key.starts_with("JOINTS_") || target.key.starts_with("WEIGHTS_")) {
      return "can't be morphed";
    }
    if (base == nullptr) return "morphs an attribute that the primitive does not have";
    const double count = accessors_[target.value].count, wanted = accessors_[*base].count;
    if (count == wanted) return {};
    return "has " + text(count) + " elements, but the primitive's has " + text(wanted);
  }

  void material(const Element& at, const Element& attributes) const {
    const JsonValue* index = at.value->find("material");
    if (index == nullptr) return;
    const MaterialTextures& textures = infos_[index_from(*index)];
    for (const auto& [name, set] : textures.sets) {
      if (attributes.value->find("TEXCOORD_" + text(set)) != nullptr) {
        if (set >= kMaxUvSets)
          asset_.warn(at.member("material"), "needs TEXCOORD_" + text(set) + " for its " + name +
                                                 ", but only the first " + text(kMaxUvSets) +
                                                 " sets are read; (0, 0) is used");
        continue;
      }
      asset_.tolerate(at.member("material"), "needs TEXCOORD_" + text(set) + " for its " + name +
                                                 ", which the primitive does not have");
    }
    if (textures.tangent_set && attributes.value->find("TANGENT") == nullptr) {
      const std::string set = "TEXCOORD_" + text(*textures.tangent_set);
      const bool has_set = attributes.value->find(set) != nullptr;
      asset_.tolerate(
          at.member("material"),
          "needs TANGENT, which the primitive does not have; " +
              (has_set ? "tangents are generated from " + set
                       : "without " + set +
                             ", too, anisotropy and the clear coat's normals are left out"));
    }
  }

  static std::string text(double number) {
    return std::to_string(static_cast<unsigned long long>(number));
  }

  Asset& asset_;
  AccessorHeads& accessors_;
  bool quantized_;
  std::vector<MaterialTextures> infos_;  // by material
};

}  // namespace

std::size_t morph_target_count(const JsonValue& mesh) {
  std::size_t most = 0;
  for (const JsonValue& primitive : mesh.find("primitives")->items())
    most = std::max(most, target_count(primitive));
  return most;
}

void check_meshes(Asset& asset, AccessorHeads& accessors) {
  MeshCheck check(asset, accessors);
  for (std::size_t i = 0; i < asset.array("meshes").size(); ++i) {
    check.mesh(asset.element("meshes", i));
  }
}

}  // namespace microtrace::io::gltf

#include "io/gltf/check/values/data.hpp"

#include "io/gltf/check/values/element_bounds.hpp"
#include "io/gltf/check/values/elements.hpp"
#include "io/gltf/check/values/influences.hpp"
#include "io/gltf/check/values/uses.hpp"
#include "io/gltf/document/properties.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace microtrace::io::gltf {
namespace {

class DataCheck {
 public:
  DataCheck(Asset& asset, const Element& at, const Elements& elements)
      : asset_(asset), at_(at), elements_(elements) {}

  void bounds() const {
    const bool is_float = elements_.component_type() == kFloat32;
    const bool has_bounds = at_.value->find("min") != nullptr || at_.value->find("max") != nullptr;
    if (!has_bounds) {
      if (is_float && !all_finite(elements_)) tolerate_not_finite();
      return;
    }
    const ElementBounds found = bounds_of(elements_);
    if (!found.all_finite) tolerate_not_finite();
    same("min", found.least, is_float);
    same("max", found.greatest, is_float);
  }

  void uses(const AccessorUses& uses) const {
    switch (elements_.component_type()) {
      case kInt8:
        return directions<std::int8_t>(uses);
      case kUint8:
        return directions<std::uint8_t>(uses);
      case kInt16:
        return directions<std::int16_t>(uses);
      case kUint16:
        return directions<std::uint16_t>(uses);
      case kFloat32:
        break;
      default:
        return;
    }
    directions<float>(uses);
    if (uses.colors) colors();
    if (uses.times) times();
    if (uses.matrices) matrices();
  }

 private:
  void same(const char* key, const std::array<double, kMaxComponents>& found, bool is_float) const {
    const JsonValue* given = at_.value->find(key);
    if (given == nullptr) return;
    for (std::size_t k = 0; k < given->items().size(); ++k) {
      const double number = given->items()[k].number();
      const double rounded = is_float ? static_cast<double>(static_cast<float>(number)) : number;
      if (rounded != found[k]) {
        asset_.tolerate(at_.member(key),
                        std::string("is not the ") +
                            (key == std::string_view("min") ? "least" : "greatest") +
                            " of the accessor's elements");
        return;
      }
    }
  }

  void tolerate_not_finite() const {
    std::size_t first = 0;
    const auto is_finite = [&](std::size_t element) {
      for (std::size_t k = 0; k < elements_.components(); ++k) {
        if (!std::isfinite(elements_.at<float>(element, k))) return false;
      }
      return true;
    };
    while (is_finite(first)) ++first;
    asset_.tolerate(at_, "element " + std::to_string(first) + " is not finite");
  }

  /// Returns a component of an element whose integers are normalized.
  template <typename Number>
  [[nodiscard]] float normalized(std::size_t element, std::size_t component) const {
    const auto value = static_cast<float>(elements_.at<Number>(element, component));
    if constexpr (std::is_floating_point_v<Number>) return value;
    return std::max(value / static_cast<float>(std::numeric_limits<Number>::max()), -1.0F);
  }

  /// Checks elements that must be of unit length.
  template <typename Number>
  void directions(const AccessorUses& uses) const {
    // Rounding four components to 8 bits can change the length by 1/127, and its square by twice
    // as much.
    constexpr float kSlack = sizeof(Number) == 1 ? 0.016F : 0.01F;
    const auto has_unit_length = [this](std::size_t element, std::size_t components) {
      float square = 0;
      for (std::size_t k = 0; k < components; ++k) {
        const float value = normalized<Number>(element, k);
        square += value * value;
      }
      return std::abs(square - 1) <= kSlack;
    };
    if (uses.normals || uses.tangents) {
      each(1, 0, " of its elements are not unit vectors, as normals and tangents must be",
           [&](std::size_t i) { return has_unit_length(i, 3); });
    }
    if (uses.tangents) {
      each(1, 0, " of its tangents have a w that is neither 1 nor -1",
           [&](std::size_t i) { return std::abs(normalized<Number>(i, 3)) == 1; });
    }
    if (uses.quaternions) {
      // In a cubic spline, only the middle one of each three elements is a rotation.
      each(uses.spline ? 3 : 1, uses.spline ? 1 : 0, " of its rotations are not unit quaternions",
           [&](std::size_t i) { return has_unit_length(i, 4); });
    }
  }

  /// Warns once, with the number of elements that fail the test.
  template <typename Test>
  void each(std::size_t step, std::size_t first, const char* message, Test&& test) const {
    std::size_t bad = 0;
    for (std::size_t i = first; i < elements_.count(); i += step) bad += test(i) ? 0 : 1;
    if (bad != 0) asset_.tolerate(at_, std::to_string(bad) + message);
  }

  void colors() const {
    each(1, 0, " of its colors are not between 0 and 1", [this](std::size_t i) {
      bool inside = true;
      for (std::size_t k = 0; k < elements_.components(); ++k) {
        const auto value = elements_.at<float>(i, k);
        inside = inside && value >= 0 && value <= 1;
      }
      return inside;
    });
  }

  void times() const {
    each(1, 0, " of its times are negative",
         [this](std::size_t i) { return elements_.at<float>(i, 0) >= 0; });
    for (std::size_t i = 1; i < elements_.count(); ++i) {
      if (elements_.at<float>(i - 1, 0) < elements_.at<float>(i, 0)) continue;
      return asset_.tolerate(
          at_, "element " + std::to_string(i) +
                   " is not greater than the one before it, as animation times must be");
    }
  }

  void matrices() const {
    each(1, 0, " of its matrices do not have the last row 0, 0, 0, 1", [this](std::size_t i) {
      const auto is = [&](std::size_t k, float value) {
        return std::abs(elements_.at<float>(i, k) - value) <= 1e-5F;
      };
      return is(3, 0) && is(7, 0) && is(11, 0) && is(15, 1);
    });
  }

  Asset& asset_;
  const Element& at_;
  const Elements& elements_;
};

/// Checks the indices of primitives without positions. make_surfaces checks all other indices.
class IndexCheck {
 public:
  IndexCheck(Asset& asset, const Model& model, const BufferViews& views)
      : asset_(asset), model_(model), views_(views), greatest_(model.accessors.size()) {}

  void primitive(const JsonValue& primitive) {
    const JsonValue* indices = primitive.find("indices");
    const JsonValue& attributes = *primitive.find("attributes");
    if (indices == nullptr || attributes.find("POSITION") != nullptr) return;
    const std::size_t accessor = index_from(*indices), count = vertex_count(attributes);
    const std::optional<double> vertex = greatest(accessor);
    if (!vertex || *vertex < static_cast<double>(count)) return;
    asset_.tolerate(
        asset_.element("accessors", accessor),
        "has indices beyond the " + std::to_string(count) + " vertices of the primitive");
  }

 private:
  [[nodiscard]] std::size_t vertex_count(const JsonValue& attributes) const {
    if (attributes.members().empty()) return 0;
    return model_.accessors[index_from(attributes.members()[0].value)].count;
  }

  /// Returns the greatest index in an accessor. Nothing if Elements::of can't read the accessor.
  std::optional<double> greatest(std::size_t accessor) {
    std::optional<double>& result = greatest_[accessor];
    if (result) return result;
    const auto elements = Elements::of(asset_, model_, views_, accessor);
    if (elements) result = bounds_of(*elements).greatest[0];
    return result;
  }

  Asset& asset_;
  const Model& model_;
  const BufferViews& views_;
  std::vector<std::optional<double>> greatest_;  // by accessor; empty until first needed
};

/// Limits the total size, because overlapping accessors of a small file could take a long time to
/// read.
void check_size(const Asset& asset, const Model& model) {
  double bytes = 0;
  for (std::size_t i = 0; i < model.accessors.size(); ++i) {
    const Model::Accessor& accessor = model.accessors[i];
    if (!accessor.view && !accessor.sparse) continue;
    bytes += static_cast<double>(accessor.count) *
             static_cast<double>(element_size(accessor.type, accessor.component_type));
    if (bytes <= static_cast<double>(kMaxBufferBytes)) continue;
    asset.fail(asset.element("accessors", i).member("count"),
               "brings the elements of all accessors to more than 4 GiB, the limit",
               ErrorKind::limit);
  }
}

}  // namespace

void check_data(Asset& asset, const Model& model, const BufferViews& views) {
  check_size(asset, model);
  const std::vector<AccessorUses> uses = accessor_uses(asset);
  for (std::size_t i = 0; i < model.accessors.size(); ++i) {
    const auto elements = Elements::of(asset, model, views, i);
    if (!elements) continue;
    const Element at = asset.element("accessors", i);
    const DataCheck check(asset, at, *elements);
    check.bounds();
    check.uses(uses[i]);
  }
  IndexCheck indices(asset, model, views);
  for (const JsonValue& mesh : asset.array("meshes")) {
    for (const JsonValue& each : mesh.find("primitives")->items()) indices.primitive(each);
  }
  check_influences(asset, model, views);
}

}  // namespace microtrace::io::gltf

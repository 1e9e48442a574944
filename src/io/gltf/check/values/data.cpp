#include "io/gltf/check/values/data.hpp"

#include "io/gltf/check/values/elements.hpp"
#include "io/gltf/check/values/influences.hpp"
#include "io/gltf/check/values/uses.hpp"
#include "io/gltf/document/properties.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace microtrace::io::gltf {
namespace {

constexpr std::size_t kMaxComponents = 16;

struct Bounds {
  std::array<double, kMaxComponents> least{}, greatest{};
  bool all_finite = true;
};

template <typename Number, std::size_t components>
Bounds bounds_of(const Elements& elements) {
  std::array<Number, components> least{}, greatest{}, doubt{};
  least.fill(std::numeric_limits<Number>::max());
  greatest.fill(std::numeric_limits<Number>::lowest());
  for (std::size_t i = 0; i < elements.count(); ++i) {
    const auto element = elements.at<std::array<Number, components>>(i, 0);
    for (std::size_t k = 0; k < components; ++k) {
      least[k] = element[k] < least[k] ? element[k] : least[k];
      greatest[k] = element[k] > greatest[k] ? element[k] : greatest[k];
      // x * 0 is 0 unless x is infinite or NaN.
      if constexpr (std::is_floating_point_v<Number>) doubt[k] += element[k] * Number(0);
    }
  }
  Bounds result;
  std::ranges::copy(least, result.least.begin());
  std::ranges::copy(greatest, result.greatest.begin());
  result.all_finite = std::ranges::all_of(doubt, [](Number sum) { return sum == 0; });
  return result;
}

/// Returns true if no number is infinite or NaN, which have an exponent of all ones.
bool all_finite(const Elements& elements) {
  constexpr std::uint32_t kExponent = 0x7F800000;
  const std::size_t components = elements.components();
  std::uint32_t bad = 0;
  if (elements.stride() == components * sizeof(float)) {
    for (std::size_t i = 0; i < elements.count() * components; ++i) {
      bad |= (elements.at<std::uint32_t>(0, i) & kExponent) == kExponent ? 1U : 0U;
    }
    return bad == 0;
  }
  for (std::size_t i = 0; i < elements.count(); ++i) {
    for (std::size_t k = 0; k < components; ++k) {
      bad |= (elements.at<std::uint32_t>(i, k) & kExponent) == kExponent ? 1U : 0U;
    }
  }
  return bad == 0;
}

template <typename Number>
Bounds bounds_of(const Elements& elements) {
  switch (elements.components()) {
    case 1:
      return bounds_of<Number, 1>(elements);
    case 2:
      return bounds_of<Number, 2>(elements);
    case 3:
      return bounds_of<Number, 3>(elements);
    case 4:
      return bounds_of<Number, 4>(elements);
    case 9:
      return bounds_of<Number, 9>(elements);
    default:
      return bounds_of<Number, 16>(elements);
  }
}

Bounds bounds_of(const Elements& elements) {
  switch (elements.component_type()) {
    case kInt8:
      return bounds_of<std::int8_t>(elements);
    case kUint8:
      return bounds_of<std::uint8_t>(elements);
    case kInt16:
      return bounds_of<std::int16_t>(elements);
    case kUint16:
      return bounds_of<std::uint16_t>(elements);
    case kUint32:
      return bounds_of<std::uint32_t>(elements);
    default:
      return bounds_of<float>(elements);
  }
}

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
    const Bounds found = bounds_of(elements_);
    if (!found.all_finite) tolerate_not_finite();
    same("min", found.least, is_float);
    same("max", found.greatest, is_float);
  }

  void uses(const AccessorUses& uses) const {
    if (elements_.component_type() != kFloat32) return;
    if (uses.normals || uses.tangents) unit_vectors();
    if (uses.tangents) signs();
    if (uses.colors) colors();
    if (uses.quaternions) quaternions(uses.spline);
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

  [[nodiscard]] float square_of(std::size_t element, std::size_t components) const {
    float square = 0;
    for (std::size_t k = 0; k < components; ++k) {
      const auto value = elements_.at<float>(element, k);
      square += value * value;
    }
    return square;
  }

  /// Warns once, with the number of elements that fail the test.
  template <typename Test>
  void each(std::size_t step, std::size_t first, const char* message, Test&& test) const {
    std::size_t bad = 0;
    for (std::size_t i = first; i < elements_.count(); i += step) bad += test(i) ? 0 : 1;
    if (bad != 0) asset_.tolerate(at_, std::to_string(bad) + message);
  }

  void unit_vectors() const {
    each(1, 0, " of its elements are not unit vectors, as normals and tangents must be",
         [this](std::size_t i) { return std::abs(square_of(i, 3) - 1) <= 0.01F; });
  }

  void signs() const {
    each(1, 0, " of its tangents have a w that is neither 1 nor -1",
         [this](std::size_t i) { return std::abs(elements_.at<float>(i, 3)) == 1; });
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

  /// In a cubic spline, only the middle one of each three elements is a rotation.
  void quaternions(bool spline) const {
    each(spline ? 3 : 1, spline ? 1 : 0, " of its rotations are not unit quaternions",
         [this](std::size_t i) { return std::abs(square_of(i, 4) - 1) <= 0.01F; });
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

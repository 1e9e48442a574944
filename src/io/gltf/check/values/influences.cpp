#include "io/gltf/check/values/influences.hpp"

#include "io/gltf/check/values/elements.hpp"
#include "io/gltf/document/properties.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace microtrace::io::gltf {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// For each mesh, the number of joints of the smallest skin applied to it, or kNone.
std::vector<std::size_t> joint_counts(const Model& model) {
  std::vector<std::size_t> result(model.meshes.size(), kNone);
  for (const Model::Node& node : model.nodes) {
    if (!node.mesh || !node.skin) continue;
    std::size_t& least = result[*node.mesh];
    least = std::min(least, model.skins[*node.skin].joints.size());
  }
  return result;
}

class InfluenceCheck {
 public:
  InfluenceCheck(Asset& asset, const Model& model, const BufferViews& views)
      : asset_(asset), model_(model), views_(views) {}

  void primitive(const Element& attributes, std::size_t joint_count) {
    sets_.clear();
    for (std::size_t set = 0;; ++set) {
      const std::string number = std::to_string(set);
      const JsonValue* joints = attributes.value->find("JOINTS_" + number);
      const JsonValue* weights = attributes.value->find("WEIGHTS_" + number);
      if (joints == nullptr || weights == nullptr) break;
      const auto index = index_from(*joints);
      vertices_ += model_.accessors[index].count;
      if (vertices_ > kMaxElements) {
        asset_.fail(attributes, "brings the asset to more than 2^27 skinned vertices",
                    ErrorKind::limit);
      }
      auto joint_elements = elements(*joints), weight_elements = elements(*weights);
      if (!joint_elements || !weight_elements) return;
      check_joints(attributes.member("JOINTS_" + number), *joint_elements, *weight_elements,
                   joint_count);
      sets_.emplace_back(std::move(*joint_elements), std::move(*weight_elements));
    }
    if (!sets_.empty()) check_weights(attributes.member("WEIGHTS_0"));
  }

 private:
  [[nodiscard]] std::optional<Elements> elements(const JsonValue& index) const {
    return Elements::of(asset_, model_, views_, index_from(index));
  }

  static std::size_t joint(const Elements& joints, std::size_t vertex, std::size_t k) {
    return joints.component_type() == kUint8 ? std::size_t{joints.at<std::uint8_t>(vertex, k)}
                                             : std::size_t{joints.at<std::uint16_t>(vertex, k)};
  }

  static double weight(const Elements& weights, std::size_t vertex, std::size_t k) {
    switch (weights.component_type()) {
      case kUint8:
        return weights.number(vertex, k) / 255;
      case kUint16:
        return weights.number(vertex, k) / 65535;
      default:
        return weights.number(vertex, k);
    }
  }

  void check_joints(const Element& at, const Elements& joints, const Elements& weights,
                    std::size_t joint_count) const {
    std::size_t unused = 0;
    for (std::size_t i = 0; i < joints.count(); ++i) {
      for (std::size_t k = 0; k < 4; ++k) {
        if (joint(joints, i, k) < joint_count) continue;
        if (i < weights.count() && weight(weights, i, k) == 0) {
          ++unused;
          continue;
        }
        asset_.fail(at, "vertex " + std::to_string(i) + " refers to joint " +
                            std::to_string(joint(joints, i, k)) + " of a skin of only " +
                            std::to_string(joint_count));
      }
    }
    if (unused != 0) {
      asset_.tolerate(at, "refers " + std::to_string(unused) +
                              " times to joints that the skin does not have, with a weight of 0");
    }
  }

  void check_weights(const Element& at) const {
    // glTF 2.0, section 3.7.3.3, allows the sum to differ from 1 by this number for each nonzero
    // weight. The tolerance is so small that sums of integer weights must be exact.
    constexpr double kTolerance = 2e-7;
    bool negative = false, twice = false;
    std::size_t unequal = 0;
    for (std::size_t i = 0; i < sets_[0].first.count(); ++i) {
      double sum = 0, terms = 0;
      for (const auto& [joints, weights] : sets_) {
        for (std::size_t k = 0; k < 4; ++k) {
          const double w = weight(weights, i, k);
          sum += w;
          terms += w != 0 ? 1 : 0;
          negative = negative || w < 0;
          for (std::size_t other = 0; other < k && w != 0; ++other) {
            twice = twice || (joint(joints, i, other) == joint(joints, i, k) &&
                              weight(weights, i, other) != 0);
          }
        }
      }
      unequal += std::abs(sum - 1) <= kTolerance * terms ? 0 : 1;
    }
    if (unequal != 0) {
      asset_.tolerate(at, "has vertices whose weights do not add up to 1, " +
                              std::to_string(unequal) + " in all; the weights are normalized");
    }
    if (negative) asset_.tolerate(at, "has negative weights");
    if (twice) asset_.tolerate(at, "has vertices with the same joint twice");
  }

  Asset& asset_;
  const Model& model_;
  const BufferViews& views_;
  std::vector<std::pair<Elements, Elements>> sets_;  // joints and weights of each set
  std::size_t vertices_ = 0;                         // checked vertices, limited by kMaxElements
};

}  // namespace

void check_influences(Asset& asset, const Model& model, const BufferViews& views) {
  InfluenceCheck check(asset, model, views);
  const std::vector<std::size_t> counts = joint_counts(model);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == kNone) continue;
    const Element primitives = asset.element("meshes", i).member("primitives");
    for (std::size_t k = 0; k < primitives.value->items().size(); ++k) {
      check.primitive(primitives.item(k).member("attributes"), counts[i]);
    }
  }
}

}  // namespace microtrace::io::gltf

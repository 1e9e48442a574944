#include "io/gltf/pose/skins.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>

namespace microtrace::io::gltf {

DMat4 JointBlend::world_from_mesh(std::size_t vertex) const {
  DMat4 result(0);
  double sum = 0;
  for (const Influences& set : sets_) {
    for (glm::length_t k = 0; k < 4; ++k) {
      const double weight = set.weights[vertex][k];
      if (weight == 0) continue;
      result += (*world_from_mesh_)[set.joints[vertex][k]] * weight;
      sum += weight;
    }
  }
  return result / sum;
}

const std::vector<DMat4>& Skins::matrices(std::size_t skin) {
  const auto [found, is_new] = matrices_.try_emplace(skin);
  std::vector<DMat4>& result = found->second;
  if (!is_new) return result;
  const auto& [joints, inverse_bind_matrices] = model_.skins[skin];
  for (const std::size_t joint : joints) result.push_back(world_from_node_[joint]);
  if (!inverse_bind_matrices || result.empty()) return result;
  if (!reader_.has_data(*inverse_bind_matrices)) {
    asset_.warn(asset_.element("skins", skin).member("inverseBindMatrices"),
                "need data that is not there; identity matrices are used");
    return result;
  }
  std::vector<std::uint32_t> numbers(result.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  const auto inverse = reader_.read<glm::mat4>(*inverse_bind_matrices, numbers);
  for (std::size_t i = 0; i < result.size(); ++i) {
    DMat4 joint_from_mesh(inverse[i]);
    for (glm::length_t column = 0; column < 4; ++column) {
      joint_from_mesh[column][3] = column == 3 ? 1 : 0;  // the last row that glTF 2.0 requires
    }
    result[i] *= joint_from_mesh;
  }
  return result;
}

std::optional<JointBlend> Skins::blend(std::size_t skin, std::size_t mesh, const Surface& surface) {
  const Model::Primitive& primitive = model_.meshes[mesh].primitives[surface.number];
  const Element attributes =
      asset_.element("meshes", mesh).member("primitives").item(surface.number).member("attributes");
  JointBlend result;
  for (std::size_t set = 0;; ++set) {
    const auto joints = primitive.attributes.find("JOINTS_" + std::to_string(set));
    const auto weights = primitive.attributes.find("WEIGHTS_" + std::to_string(set));
    if (joints == primitive.attributes.end() || weights == primitive.attributes.end()) break;
    if (!reader_.has_data(joints->second) || !reader_.has_data(weights->second)) {
      asset_.warn(attributes.member(joints->first), "has no data; the attribute is left out");
      break;
    }
    result.sets_.push_back({reader_.read<glm::uvec4>(joints->second, surface.vertices),
                            reader_.read<glm::vec4>(weights->second, surface.vertices)});
  }
  const std::vector<DMat4>& joint_matrices = matrices(skin);
  if (result.sets_.empty() || joint_matrices.empty()) return std::nullopt;
  result.world_from_mesh_ = &joint_matrices;
  for (std::size_t set = 0; set < result.sets_.size(); ++set) {
    auto& [all_joints, all_weights] = result.sets_[set];
    for (std::size_t i = 0; i < all_joints.size(); ++i) {
      for (glm::length_t k = 0; k < 4; ++k) {
        std::uint32_t& joint = all_joints[i][k];
        if (joint < joint_matrices.size()) continue;
        if (all_weights[i][k] != 0) {
          asset_.fail(attributes.member("JOINTS_" + std::to_string(set)),
                      "names joint " + std::to_string(joint) + ", but /skins/" +
                          std::to_string(skin) + " has only " +
                          std::to_string(joint_matrices.size()) + ", counted from 0");
        }
        joint = 0;  // exporters fill unused influences with any number
      }
    }
  }
  check_weights(attributes, result);
  return result;
}

void Skins::check_weights(const Element& attributes, JointBlend& blend) {
  const std::size_t vertices = blend.sets_[0].weights.size();
  for (std::size_t i = 0; i < vertices; ++i) {
    double sum = 0;
    for (const auto& set : blend.sets_) {
      for (glm::length_t k = 0; k < 4; ++k) sum += set.weights[i][k];
    }
    if (!(std::abs(sum) > 0) || !std::isfinite(sum)) {
      asset_.warn(attributes.member("WEIGHTS_0"),
                  "has vertices without weights; they follow their first joint");
      for (auto& set : blend.sets_) set.weights[i] = glm::vec4(0);
      blend.sets_[0].weights[i].x = 1;
    }
  }
}

}  // namespace microtrace::io::gltf

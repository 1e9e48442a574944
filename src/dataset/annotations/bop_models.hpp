#pragma once
/// The models of objects in the format of BOP.

#include "dataset/annotations/bop.hpp"

#include <microtrace/math.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace microtrace::dataset {

struct BopModel {
  std::uint32_t id = 0;  ///< obj_id
  NamedFile file;        ///< models/obj_NNNNNN.ply, relative to the data set's folder
  std::string info;      ///< the model's member of models_info.json
};

/// Returns the model of an object, in millimeters, or nothing if the object is neither a mesh nor a
/// triangle, or has no vertex. The model is a binary PLY file with the mesh's normals, if it has
/// any. The diameter is the largest distance between two vertices.
[[nodiscard]] std::optional<BopModel> bop_model(const Scene& scene, std::uint32_t object,
                                                const BopFrames& frames,
                                                const BopOptions& options = {});

/// Returns models_info.json for models in the order of their ids.
[[nodiscard]] std::string bop_models_info(std::span<const BopModel> models);

/// Returns the largest distance between two of the points; 0 if there are fewer than two.
[[nodiscard]] double diameter(std::span<const DVec3> points);

}  // namespace microtrace::dataset

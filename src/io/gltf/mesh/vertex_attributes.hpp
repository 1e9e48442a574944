#pragma once
/// Reads vertex attributes other than positions.

#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <microtrace/io.hpp>
#include <microtrace/material.hpp>
#include <microtrace/shape.hpp>

#include <cstdint>
#include <span>

namespace microtrace::io::gltf {

/// The attributes that the vertices of a primitive need.
struct AttributeWish {
  const Material& material;  ///< material of the primitive
  SurfaceDetail detail;
};

/// Reads normals, tangents, texture coordinates and colors into the mesh. Reads only vertices with
/// the indices `vertices`, which must ascend. Replaces numbers that are not finite by 0. Omits
/// attributes without data. Throws Error (invalid_scene) for an accessor of a type that neither
/// glTF 2.0 nor KHR_mesh_quantization allows.
void read_attributes(Asset& asset, const Model& model, AccessorReader& reader,
                     const Element& attributes, const Model::Primitive& primitive,
                     std::span<const std::uint32_t> vertices, const AttributeWish& wish,
                     Mesh& mesh);

}  // namespace microtrace::io::gltf

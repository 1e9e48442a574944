#pragma once
/// What vertices carry beside their positions.

#include "io/gltf/bytes/accessors.hpp"
#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/model.hpp"

#include <microtrace/io.hpp>
#include <microtrace/material.hpp>
#include <microtrace/shape.hpp>

#include <cstdint>
#include <span>

namespace microtrace::io::gltf {

/// Of sets of texture coordinates, these many first ones are read; glTF 2.0 asks for two.
inline constexpr std::uint32_t max_uv_sets = 16;

/// What a primitive's vertices are asked for.
struct AttributeWish {
  const Material& material;  ///< of the primitive
  SurfaceDetail detail;
};

/// Reads normals, tangents, texture coordinates and colours of the vertices of those numbers,
/// ascending, into the mesh. Numbers that are not finite are 0; attributes without data are left
/// out. Throws Error (invalid_scene) where an accessor's type is not one that glTF 2.0 and
/// KHR_mesh_quantization allow there.
void read_attributes(Asset& asset, const Model& model, AccessorReader& reader,
                     const Element& attributes, const Model::Primitive& primitive,
                     std::span<const std::uint32_t> vertices, const AttributeWish& wish,
                     Mesh& mesh);

}  // namespace microtrace::io::gltf

/// Decodes Draco meshes behind the C interface of io/gltf/mesh/draco_abi.hpp. It uses only the
/// integer output of Draco's library, so results are the same on every machine.

#include "io/gltf/mesh/draco_abi.hpp"
#include "modules/draco/header.hpp"
#include "modules/draco/values.hpp"

#include <algorithm>
#include <draco/compression/decode.h>
#include <exception>
#include <memory>
#include <utility>

namespace {

/// Writes the corners of all triangles. Returns null, or an error message. A mesh without
/// attributes has no points; its corners are vertices of other accessors.
const char* write_indices(const draco::Mesh& mesh, bool has_points, std::uint32_t* out) {
  for (std::uint32_t i = 0; i < mesh.num_faces(); ++i) {
    for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i))) {
      if (has_points && corner.value() >= mesh.num_points())
        return "a triangle has a corner that is no point";
      *out++ = corner.value();
    }
  }
  return nullptr;
}

/// Meshes may have points that no triangle uses, but not more than as many triangles would use.
bool is_too_large(const MicrotraceDraco& wanted, std::size_t triangles, std::size_t points) {
  return triangles > wanted.most_triangles || points / 3 > wanted.most_triangles;
}

const char* decode(const MicrotraceDraco& wanted, MicrotraceDracoReserve reserve,
                   MicrotraceDracoPrepare prepare, void* context) {
  constexpr const char* kNoRoom = "there is no room for it";
  constexpr const char* kTooLarge =
      "there are more triangles or vertices than so few bytes can hold";
  const std::optional<DracoHeader> header = read_draco_header(wanted.bytes, wanted.size);
  if (!header) return "the bytes are no mesh of Draco's bitstream version 2.2";
  if (is_too_large(wanted, header->triangles, header->points)) return kTooLarge;

  // The decoder's memory for points is that of triangles with three points each.
  const std::size_t triangles = header->triangles, others = header->points / 3;
  if (reserve(context, std::max(triangles, others)) == 0) return kNoRoom;

  draco::DecoderBuffer buffer;
  buffer.Init(wanted.bytes, wanted.size);
  draco::Decoder decoder;
  for (int type = 0; type < draco::GeometryAttribute::NAMED_ATTRIBUTES_COUNT; ++type) {
    decoder.SetSkipAttributeTransform(static_cast<draco::GeometryAttribute::Type>(type));
  }
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok() && others > triangles)
    return "it has points that no triangle uses, which some versions of Draco's library reject; "
           "compress it without them";
  if (!decoded.ok()) return "the bytes are damaged";
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  const std::size_t points = mesh->num_points();
  if (is_too_large(wanted, mesh->num_faces(), points)) return kTooLarge;
  if (prepare(context, mesh->num_faces(), points) == 0) return kNoRoom;

  const bool has_points = mesh->num_attributes() > 0;
  if (const char* wrong = write_indices(*mesh, has_points, wanted.indices)) return wrong;
  for (std::size_t i = 0; i < wanted.attribute_count; ++i) {
    const MicrotraceDracoAttribute& attribute = wanted.attributes[i];
    const draco::PointAttribute* source = mesh->GetAttributeByUniqueId(attribute.id);
    if (source == nullptr) return "there is no attribute of an id that the extension names";
    if (const char* wrong = write_draco_values(*source, points, attribute)) return wrong;
  }
  return nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int microtrace_decode_draco_v2(
    const MicrotraceDraco* mesh, MicrotraceDracoReserve reserve, MicrotraceDracoPrepare prepare,
    MicrotraceDracoComplain complain, void* context) {
  try {
    const char* wrong = decode(*mesh, reserve, prepare, context);
    if (wrong != nullptr) complain(context, wrong);
    return wrong == nullptr ? 1 : 0;
  } catch (const std::exception& error) {
    complain(context, error.what());
    return 0;
  }
}

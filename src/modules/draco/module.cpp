/// Decodes meshes by Draco behind the C interface of io/gltf/draco_abi.hpp. The library is asked
/// for integers only, so that its bytes are the same on every machine.

#include "io/gltf/draco_abi.hpp"
#include "modules/draco/header.hpp"
#include "modules/draco/values.hpp"

#include <draco/compression/decode.h>
#include <exception>
#include <memory>
#include <utility>

namespace {

/// Null, or what is wrong.
const char* write_indices(const draco::Mesh& mesh, std::uint32_t* out) {
  for (std::uint32_t i = 0; i < mesh.num_faces(); ++i) {
    for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i))) {
      if (corner.value() >= mesh.num_points()) return "a triangle has a corner that is no point";
      *out++ = corner.value();
    }
  }
  return nullptr;
}

const char* decode(const MicrotraceDraco& wanted) {
  const std::optional<DracoHeader> header = read_draco_header(wanted.bytes, wanted.size);
  if (!header) return "the bytes are no mesh of Draco's bitstream version 2.2";
  if (header->triangles != wanted.triangles || header->points > wanted.points)
    return "there are not as many triangles and vertices as the accessors say";

  draco::DecoderBuffer buffer;
  buffer.Init(wanted.bytes, wanted.size);
  draco::Decoder decoder;
  for (int type = 0; type < draco::GeometryAttribute::NAMED_ATTRIBUTES_COUNT; ++type) {
    decoder.SetSkipAttributeTransform(static_cast<draco::GeometryAttribute::Type>(type));
  }
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return "the bytes are damaged";
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  if (mesh->num_faces() != wanted.triangles || mesh->num_points() != wanted.points)
    return "there are not as many triangles and vertices as the accessors say";

  if (const char* wrong = write_indices(*mesh, wanted.indices)) return wrong;
  for (std::size_t i = 0; i < wanted.attribute_count; ++i) {
    const MicrotraceDracoAttribute& attribute = wanted.attributes[i];
    const draco::PointAttribute* source = mesh->GetAttributeByUniqueId(attribute.id);
    if (source == nullptr) return "there is no attribute of an id that the extension names";
    if (const char* wrong = write_draco_values(*source, wanted.points, attribute)) return wrong;
  }
  return nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int microtrace_decode_draco_v1(
    const MicrotraceDraco* mesh, MicrotraceDracoComplain complain, void* context) {
  try {
    const char* wrong = decode(*mesh);
    if (wrong != nullptr) complain(context, wrong);
    return wrong == nullptr ? 1 : 0;
  } catch (const std::exception& error) {
    complain(context, error.what());
    return 0;
  }
}

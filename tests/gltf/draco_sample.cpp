#include "gltf/draco_sample.hpp"

#include <cmath>
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace microtrace::tests {
namespace {

std::unique_ptr<draco::Mesh> bowl() {
  constexpr std::uint32_t kPoints = kDracoRows * kDracoColumns;
  auto mesh = std::make_unique<draco::Mesh>();
  mesh->set_num_points(kPoints);
  const auto add = [&](draco::GeometryAttribute::Type type, std::uint8_t size, draco::DataType data,
                       bool normalized) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, size, data, normalized, size * draco::DataTypeLength(data), 0);
    return mesh->attribute(mesh->AddAttribute(attribute, true, kPoints));
  };
  auto* positions = add(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32, false);
  auto* normals = add(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32, false);
  auto* colors = add(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8, true);
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const double u = 2 * std::numbers::pi * (i % kDracoColumns) / kDracoColumns;
    const double v = 0.1 + 0.3 * (i / kDracoColumns);
    const Vec3 p(std::sin(v) * std::cos(u), std::sin(v) * std::sin(u), -std::cos(v));
    const std::array<std::uint8_t, 4> color = {static_cast<std::uint8_t>(i * 2), 7, 255, 255};
    positions->SetAttributeValue(draco::AttributeValueIndex(i), &p.x);
    normals->SetAttributeValue(draco::AttributeValueIndex(i), &p.x);
    colors->SetAttributeValue(draco::AttributeValueIndex(i), color.data());
  }
  for (std::uint32_t y = 0; y + 1 < kDracoRows; ++y) {
    for (std::uint32_t x = 0; x < kDracoColumns; ++x) {
      const auto at = [&](std::uint32_t row, std::uint32_t column) {
        return draco::PointIndex(row * kDracoColumns + column % kDracoColumns);
      };
      mesh->AddFace({at(y, x), at(y, x + 1), at(y + 1, x)});
      mesh->AddFace({at(y, x + 1), at(y + 1, x + 1), at(y + 1, x)});
    }
  }
  return mesh;
}

}  // namespace

extern "C" void make_draco_sample(bool sequential, DracoSample& sample) {
  draco::Encoder encoder;
  encoder.SetEncodingMethod(sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                       : draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
  draco::EncoderBuffer bytes;
  if (!encoder.EncodeMeshToBuffer(*bowl(), &bytes).ok()) throw std::runtime_error("not encoded");
  sample.bytes.assign(bytes.data(), bytes.size());

  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  const auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer).value();
  const auto id = [&](draco::GeometryAttribute::Type type) {
    return mesh->GetNamedAttribute(type)->unique_id();
  };
  sample.position_id = id(draco::GeometryAttribute::POSITION);
  sample.normal_id = id(draco::GeometryAttribute::NORMAL);
  sample.color_id = id(draco::GeometryAttribute::COLOR);
  const auto value = [&](draco::GeometryAttribute::Type type, std::uint32_t point) {
    Vec3 v(0);
    mesh->GetNamedAttribute(type)->GetMappedValue(draco::PointIndex(point), &v.x);
    return v;
  };
  for (std::uint32_t i = 0; i < mesh->num_points(); ++i) {
    sample.positions.push_back(value(draco::GeometryAttribute::POSITION, i));
    sample.normals.push_back(value(draco::GeometryAttribute::NORMAL, i));
  }
  for (std::uint32_t i = 0; i < mesh->num_faces(); ++i) {
    const draco::Mesh::Face& face = mesh->face(draco::FaceIndex(i));
    sample.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
}

}  // namespace microtrace::tests

#include "gltf/asset_builder.hpp"
#include "io/gltf/scene.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Of all vertices, in a picture of 640 x 480 whose edges are at -1 and 1.
struct Extent {
  double left = 1e300, right = -1e300, bottom = 1e300, top = -1e300;
  double nearest = 1e300;  ///< depth
};

Extent seen(const Scene& scene, const PerspectiveCamera& camera) {
  const double half_height = std::tan(camera.vertical_fov / 2);
  const DVec3 forward = glm::normalize(camera.pose.direction);
  const DVec3 right = glm::normalize(glm::cross(forward, camera.pose.up));
  const DVec3 up = glm::cross(right, forward);
  Extent extent;
  for (const Object& object : scene.objects) {
    for (const Vec3& p : std::get<Mesh>(object.shape).positions) {
      const DVec3 v = DVec3(p) - camera.pose.position;
      const double depth = glm::dot(v, forward);
      const double x = glm::dot(v, right) / depth / (half_height * 640 / 480);
      const double y = glm::dot(v, up) / depth / half_height;
      extent.left = std::min(extent.left, x);
      extent.right = std::max(extent.right, x);
      extent.bottom = std::min(extent.bottom, y);
      extent.top = std::max(extent.top, y);
      extent.nearest = std::min(extent.nearest, depth);
    }
  }
  return extent;
}

AssetBuilder model(const std::vector<Vec3>& positions) {
  AssetBuilder asset;
  asset.add_object({{"attributes", {{"POSITION", asset.add_positions(positions)}}}});
  return asset;
}

struct Model {
  const char* name;
  AssetBuilder asset;
};

std::vector<Model> models() {
  AssetBuilder far_away = cube();
  far_away.json["nodes"][0]["translation"] = {1e6, -2e6, 3e6};
  AssetBuilder tiny = cube();
  tiny.json["nodes"][0]["scale"] = {1e-12, 2e-12, 1e-12};
  AssetBuilder huge = cube();
  huge.json["nodes"][0]["scale"] = {1e20, 1e20, 5e20};
  AssetBuilder wide = cube();
  wide.json["nodes"][0]["scale"] = {100, 1, 1};
  AssetBuilder tall = cube();
  tall.json["nodes"][0]["scale"] = {1, 50, 1};
  return {{"cube", cube()},
          {"far away", far_away},
          {"tiny", tiny},
          {"huge", huge},
          {"wide", wide},
          {"tall", tall},
          {"flat in y", model({Vec3(0), Vec3(4, 0, 0), Vec3(0, 0, 9)})},
          {"flat in z", model({Vec3(0), Vec3(4, 0, 0), Vec3(0, 9, 0)})},
          {"flat in x, off center", model({Vec3(5, 5, 5), Vec3(5, 7, 5), Vec3(5, 6, 8)})}};
}

TEST(GltfFraming, AllVerticesAreInsideAndOneAxisIsFilled) {
  for (const Model& model : models()) {
    SCOPED_TRACE(model.name);
    const LoadedScene loaded = load(model.asset);
    ASSERT_EQ(loaded.scene.cameras.size(), 1U);
    EXPECT_EQ(loaded.scene.cameras[0].name, "framed");
    const auto& camera = std::get<PerspectiveCamera>(loaded.scene.cameras[0].camera);
    const Extent extent = seen(loaded.scene, camera);
    constexpr double limit = 0.9 + 1e-6;
    EXPECT_GT(extent.nearest, 0);
    EXPECT_GE(extent.left, -limit);
    EXPECT_LE(extent.right, limit);
    EXPECT_GE(extent.bottom, -limit);
    EXPECT_LE(extent.top, limit);
    const bool fills_width = extent.left < -0.9 + 1e-6 && extent.right > 0.9 - 1e-6;
    const bool fills_height = extent.bottom < -0.9 + 1e-6 && extent.top > 0.9 - 1e-6;
    EXPECT_TRUE(fills_width || fills_height)
        << extent.left << " " << extent.right << " " << extent.bottom << " " << extent.top;
  }
}

TEST(GltfFraming, ANeedleAlongTheViewKeepsItsDistance) {
  const LoadedScene loaded = load(model({Vec3(4, 4, 7), Vec3(0), Vec3(-4, -4, -7)}));
  const auto& camera = std::get<PerspectiveCamera>(loaded.scene.cameras.at(0).camera);
  EXPECT_NEAR(seen(loaded.scene, camera).nearest, 18.0 / 64, 1e-9);
}

TEST(GltfFraming, ASinglePointIsSeenFromDistanceOne) {
  const LoadedScene loaded = load(model({Vec3(5), Vec3(5), Vec3(5)}));
  const auto& camera = std::get<PerspectiveCamera>(loaded.scene.cameras.at(0).camera);
  EXPECT_NEAR(glm::distance(camera.pose.position, DVec3(5)), 1, 1e-12);
  EXPECT_NEAR(seen(loaded.scene, camera).left, 0, 1e-12);
}

TEST(GltfFraming, AnEmptyAssetHasACameraAndAWarning) {
  const LoadedScene loaded = load(R"({"asset": {"version": "2.0"}})");
  ASSERT_EQ(loaded.scene.cameras.size(), 1U);
  const auto& camera = std::get<PerspectiveCamera>(loaded.scene.cameras[0].camera);
  EXPECT_NEAR(glm::length(camera.pose.position), 1, 1e-12);
  EXPECT_THAT(texts(loaded.warnings), ElementsAre(HasSubstr("nothing to draw")));
}

TEST(GltfFraming, VerticesThatAreNotFiniteOrNotUsedDoNotCount) {
  std::vector<Vec3> positions = {Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const auto framed = [](const AssetBuilder& asset) {
    return std::get<PerspectiveCamera>(load(asset).scene.cameras.at(0).camera).pose.position;
  };
  const DVec3 expected = framed(model(positions));
  positions.insert(positions.end(), {Vec3(0), Vec3(1, 0, 0), Vec3(INFINITY)});
  EXPECT_EQ(framed(model(positions)), expected);
  positions.insert(positions.end(), {Vec3(1e9F), Vec3(-1e9F)});  // make no triangle
  EXPECT_EQ(framed(model(positions)), expected);
}

}  // namespace
}  // namespace microtrace::tests

#include "scene/validate/validate.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace microtrace {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kLeast = std::numeric_limits<float>::denorm_min();
constexpr float kMost = std::numeric_limits<float>::max();

/// Returns the first broken rule as `field: message`.
template <typename T>
std::string broken(const T& part) {
  const auto rule = validate(part);
  return rule ? rule->field + ": " + rule->message : "";
}

std::string field(const Shape& shape) {
  const auto rule = validate(shape);
  return rule ? rule->field : "";
}

std::string camera_field(const Camera& camera) {
  const auto rule = validate(camera);
  return rule ? rule->field : "";
}

TEST(ValidateShape, Sphere) {
  EXPECT_EQ(field(Sphere{}), "");
  EXPECT_EQ(field(Sphere{.center = Vec3(-kMost), .radius = kLeast}), "");
  EXPECT_EQ(broken(Shape(Sphere{.radius = -1})), "radius: must be positive, is -1");
  EXPECT_EQ(broken(Shape(Sphere{.radius = 0})), "radius: must be positive, is 0");
  EXPECT_EQ(broken(Shape(Sphere{.radius = kNan})), "radius: must be positive, is nan");
  EXPECT_EQ(field(Sphere{.radius = kInfinity}), "radius");
  EXPECT_EQ(field(Sphere{.center = Vec3(0, kNan, 0), .radius = -1}), "center");
}

TEST(ValidateShape, PlaneAndDisc) {
  EXPECT_EQ(field(Plane{.normal = Vec3(0, kLeast, 0)}), "");
  EXPECT_EQ(broken(Shape(Plane{.normal = Vec3(0, -0.0F, 0)})), "normal: must not be zero");
  EXPECT_EQ(field(Plane{.normal = Vec3(kInfinity, 0, 0)}), "normal");
  EXPECT_EQ(field(Plane{.point = Vec3(kInfinity, 0, 0)}), "point");
  EXPECT_EQ(field(Disc{}), "");
  EXPECT_EQ(field(Disc{.radius = 0}), "radius");
  EXPECT_EQ(field(Disc{.normal = Vec3(0)}), "normal");
  EXPECT_EQ(field(Disc{.center = Vec3(kNan)}), "center");
}

TEST(ValidateShape, TriangleMayBeDegenerateButIsFinite) {
  EXPECT_EQ(field(Triangle{}), "");
  EXPECT_EQ(field(Triangle{.a = Vec3(kNan)}), "a");
  EXPECT_EQ(field(Triangle{.b = Vec3(kInfinity)}), "b");
  EXPECT_EQ(field(Triangle{.c = Vec3(-kInfinity)}), "c");
}

TEST(ValidateShape, QuadricVaries) {
  EXPECT_EQ(field(Quadric{}), "coefficients");
  EXPECT_EQ(field(Quadric{.j = 1}), "coefficients");
  float Quadric::*const coefficients[] = {&Quadric::a, &Quadric::b, &Quadric::c,
                                          &Quadric::d, &Quadric::e, &Quadric::f,
                                          &Quadric::g, &Quadric::h, &Quadric::i};
  for (float Quadric::*coefficient : coefficients) {
    Quadric q;
    q.*coefficient = kLeast;
    EXPECT_EQ(field(q), "");
    q.*coefficient = kNan;
    EXPECT_EQ(field(q), "coefficients");
  }
  EXPECT_EQ(field(Quadric{.a = 1, .j = kInfinity}), "coefficients");
}

TEST(ValidateShape, MeshAttributesAreForAllVerticesOrNone) {
  Mesh mesh{.positions = {Vec3(0), Vec3(1), Vec3(2)}, .triangles = {{0, 1, 2}}};
  mesh.uv_sets = {{}, {Vec2(0), Vec2(0), Vec2(0)}};
  EXPECT_EQ(field(mesh), "");
  mesh.colors.resize(2);
  EXPECT_EQ(field(mesh), "colors");
  mesh.colors.resize(3);
  mesh.uv_sets[0].resize(4);
  EXPECT_EQ(field(mesh), "uv_sets");
}

TEST(ValidateShape, MeshIndicesExist) {
  Mesh mesh{.positions = {Vec3(0), Vec3(1), Vec3(2)}, .triangles = {{0, 1, 2}}};
  EXPECT_EQ(field(mesh), "");
  EXPECT_EQ(field(Mesh{}), "");
  mesh.triangles.push_back({0, 3, 1});
  EXPECT_EQ(broken(Shape(mesh)), "triangles: index 3 is not below the number of positions, 3");
  mesh.positions.edit()[1].y = kNan;
  EXPECT_EQ(field(mesh), "positions");
}

TEST(ValidateCamera, Pose) {
  const auto with = [](DVec3 position, DVec3 direction, DVec3 up) {
    return camera_field(EnvironmentCamera{{position, direction, up}});
  };
  const DVec3 p(0), d(0, 0, -1), up(0, 1, 0);
  EXPECT_EQ(with(p, d, up), "");
  EXPECT_EQ(with(DVec3(1e39), d, up), "position");
  EXPECT_EQ(with(DVec3(kNan), d, up), "position");
  EXPECT_EQ(with(p, DVec3(0), up), "direction");
  EXPECT_EQ(with(p, DVec3(0, 0, 1e-50), up), "direction");
  EXPECT_EQ(with(p, DVec3(1e-44), up), "");
  EXPECT_EQ(with(p, DVec3(1e38, 1e38, -1e38), up), "");
  EXPECT_EQ(with(p, d, DVec3(0)), "up");
  EXPECT_EQ(with(p, d, DVec3(0, 0, 5)), "up");
  EXPECT_EQ(with(p, DVec3(0.1, 0.2, 0.3), DVec3(-0.3, -0.6, -0.9)), "up");
  EXPECT_EQ(with(p, d, DVec3(0, 1e-10, 1)), "up");
  EXPECT_EQ(with(p, d, DVec3(0, 1e-8, 1)), "");
}

TEST(ValidateCamera, Perspective) {
  const auto with_fov = [](double fov) {
    PerspectiveCamera camera;
    camera.vertical_fov = fov;
    return camera_field(camera);
  };
  EXPECT_EQ(with_fov(1), "");
  EXPECT_EQ(with_fov(1e-300), "");
  EXPECT_EQ(with_fov(std::nextafter(std::numbers::pi, 0)), "");
  for (const double fov : {0.0, -1.0, std::numbers::pi, 4.0, double{kNan}}) {
    EXPECT_EQ(with_fov(fov), "vertical_fov") << fov;
  }
  PerspectiveCamera camera;
  camera.aspect_ratio = 1.5;
  EXPECT_EQ(camera_field(camera), "");
  camera.aspect_ratio = 0;
  EXPECT_EQ(camera_field(camera), "aspect_ratio");
  camera.focus = kNan;
  EXPECT_EQ(camera_field(camera), "focus");
  camera.focus = 0;
  EXPECT_EQ(camera_field(camera), "focus");
  camera.focus = 1;
  for (const double radius : {-1.0, 1e39, double{kNan}}) {
    camera.lens_radius = radius;
    EXPECT_EQ(camera_field(camera), "lens_radius") << radius;
  }
  camera.lens_radius = 1e30;
  camera.focus = 1e-40;
  EXPECT_EQ(camera_field(camera), "lens_radius");
}

TEST(ValidateCamera, OrthographicAndDepth) {
  OrthographicCamera camera;
  EXPECT_EQ(camera_field(camera), "");
  const auto with_depth = [&](double near, double far) {
    camera.depth = {.near = near, .far = far};
    return camera_field(camera);
  };
  EXPECT_EQ(with_depth(0.1, 100), "");
  EXPECT_EQ(with_depth(-0.1, 100), "near");
  EXPECT_EQ(with_depth(double{kNan}, 100), "near");
  EXPECT_EQ(with_depth(double{kInfinity}, double{kInfinity}), "near");
  EXPECT_EQ(with_depth(1, 1), "far");
  EXPECT_EQ(with_depth(1, double{kNan}), "far");
  camera.height = 0;
  EXPECT_EQ(camera_field(camera), "height");
  camera.height = 1e39;
  EXPECT_EQ(camera_field(camera), "height");
}

TEST(ValidateImageSize, SidesAndProduct) {
  EXPECT_EQ(broken(ImageSize{1, 1}), "");
  EXPECT_EQ(broken(ImageSize{65536, 4096}), "");
  EXPECT_EQ(broken(ImageSize{0, 1}), "width: must be at least 1 pixel, is 0");
  EXPECT_EQ(validate(ImageSize{1, 0})->kind, ErrorKind::invalid_scene);
  EXPECT_EQ(broken(ImageSize{1, 65537}), "height: must be at most 65536 pixels, is 65537");
  EXPECT_EQ(validate(ImageSize{65537, 1})->kind, ErrorKind::limit);
  EXPECT_EQ(validate(ImageSize{65536, 4097})->kind, ErrorKind::limit);
  EXPECT_EQ(validate(ImageSize{65536, 65536})->field, "");
  EXPECT_EQ(validate(ImageSize{0xFFFFFFFF, 0xFFFFFFFF})->kind, ErrorKind::limit);
}

TEST(Decimal, IsShortestAndRoundTrips) {
  EXPECT_EQ(decimal(0.1), "0.1");
  EXPECT_EQ(decimal(0.1F), "0.1");
  EXPECT_EQ(decimal(-1.0), "-1");
  EXPECT_EQ(decimal(1e300), "1e+300");
}

TEST(ValidateMaterial, Ranges) {
  EXPECT_EQ(broken(Material{}), "");
  Material all{.emissive = Vec3(kMost), .ior = 0};
  all.specular.emplace();
  all.transmission.emplace();
  all.volume.emplace();
  all.volume_scatter.emplace();
  all.clearcoat.emplace();
  all.sheen.emplace();
  all.anisotropy.emplace();
  all.iridescence.emplace();
  all.diffuse_transmission.emplace();
  all.specular_glossiness.emplace();
  EXPECT_EQ(broken(all), "");
  EXPECT_EQ(broken(Material{.roughness = 7}), "roughness: must be from 0 to 1, is 7");
  EXPECT_EQ(broken(Material{.base_color = {1, 1, kNan, 1}}),
            "base_color: must be from 0 to 1, is nan");
  EXPECT_EQ(broken(Material{.emissive = Vec3(kInfinity)}),
            "emissive: must be finite and at least 0, is inf");
  EXPECT_EQ(broken(Material{.ior = 0.5F}), "ior: must be finite and at least 1, is 0.5");
  all.clearcoat->roughness = -1;
  EXPECT_EQ(broken(all), "clearcoat/roughness: must be from 0 to 1, is -1");
  all.clearcoat.reset();
  all.volume_scatter->anisotropy = 1.5F;
  EXPECT_EQ(broken(all), "volume_scatter/anisotropy: must be from -1 to 1, is 1.5");
  all.volume_scatter->multiscatter_color = Vec3(0, 0, 2);
  EXPECT_THAT(broken(all), testing::StartsWith("volume_scatter/multiscatter_color: "));
  all.volume->attenuation_distance = 0;
  EXPECT_EQ(broken(all), "volume/attenuation_distance: must be positive");
}

TEST(ValidateLight, Ranges) {
  EXPECT_EQ(broken(Light(DirectionalLight{})), "");
  EXPECT_EQ(broken(Light(PointLight{})), "");
  EXPECT_EQ(broken(Light(SpotLight{})), "");
  EXPECT_EQ(broken(Light(PointLight{.intensity = -1})),
            "intensity: must be finite and at least 0, is -1");
  EXPECT_EQ(broken(Light(PointLight{.range = 0})), "range: must be positive");
  EXPECT_THAT(broken(Light(SpotLight{.inner_angle = 1, .outer_angle = 1})),
              testing::StartsWith("outer_angle: must be above inner_angle"));
  EXPECT_THAT(broken(Light(DirectionalLight{.direction = {kNan, 0, 0}})),
              testing::StartsWith("direction: "));
  EXPECT_EQ(broken(Environment{}), "");
  EXPECT_THAT(broken(Environment{.content = Vec3(-1)}), testing::StartsWith("content: "));
  EXPECT_THAT(broken(Environment{.intensity = kNan}), testing::StartsWith("intensity: "));
}

}  // namespace
}  // namespace microtrace

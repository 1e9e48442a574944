#include "vs_embree_scenes.hpp"

#include "rays.hpp"
#include "support/cases/generated_meshes.hpp"

#include <microtrace/io.hpp>
#include <microtrace/primitives.hpp>

#include <filesystem>
#include <memory>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace microtrace::bench {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Copies the positions to memory that extends past the last one, because Embree reads 16 bytes for
/// each position.
Array<Vec3> padded(Array<Vec3> positions) {
  const std::size_t size = positions.size();
  const auto owner = std::make_shared<std::vector<Vec3>>(std::move(positions.edit()));
  owner->resize(size + 1);
  return Array<Vec3>::borrow(std::span(*owner).first(size), owner);
}

BenchScene make_scene(std::string name, Mesh mesh, const Pose& pose, double vertical_fov) {
  mesh.positions = padded(std::move(mesh.positions));
  BenchScene made{.name = std::move(name),
                  .scene = {},
                  .camera = {.pose = pose, .vertical_fov = vertical_fov * kDegree}};
  made.scene.objects.push_back({.name = made.name, .shape = std::move(mesh)});
  return made;
}

BenchScene named_sphere(std::string name, std::size_t triangles) {
  const Pose pose{.position = {0.3, 0.5, 2}, .direction = {-0.3, -0.5, -2}};
  return make_scene(std::move(name), generated::displaced_sphere(triangles), pose, 45);
}

/// A thousand instances of a displaced sphere, each turned and scaled in its own way.
BenchScene field(std::size_t triangles) {
  constexpr int kSide = 32;
  const Pose pose{.position = {0, 18, 55}, .direction = {0, -0.4, -0.92}};
  BenchScene made = make_scene("field", generated::displaced_sphere(triangles), pose, 40);
  Mesh mesh = std::get<Mesh>(made.scene.objects[0].shape);
  made.scene.objects.clear();
  for (int i = 0; i < 1000; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    const DVec3 axis = random_point(1, 2 * number), offset = random_point(1, 2 * number + 1);
    const DVec3 place(2.7 * (i % kSide - kSide / 2), 0, 2.7 * (i / kSide - kSide / 2));
    DMat4 m = glm::translate(DMat4(1), place + 0.5 * offset);
    m = glm::scale(glm::rotate(m, std::numbers::pi * offset.x, axis), DVec3(1 + 0.4 * offset.y));
    mesh.placement = std::make_shared<const Placement>(m);
    made.scene.objects.push_back({.name = std::to_string(i), .shape = mesh});
  }
  return made;
}

}  // namespace

const std::vector<std::string>& generated_scene_names() {
  static const std::vector<std::string> names{"sphere", "hall", "terrain", "field"};
  return names;
}

BenchScene generated_scene(const std::string& name, bool small) {
  const std::size_t million = small ? 10'000 : 1'000'000;
  if (name == "sphere") return named_sphere(name, million);
  if (name == "hall") {
    const Pose pose{.position = {-18, 3, 1}, .direction = {1, -0.03, -0.12}};
    return make_scene(name, generated::hall(million), pose, 60);
  }
  if (name == "terrain") {
    const Pose pose{.position = {0.07, 0.9, 1.2}, .direction = {-0.1, -0.9, -1.2}};
    return make_scene(name, generated::terrain(10 * million), pose, 45);
  }
  if (name == "field") return field(million / 10);
  throw std::invalid_argument("no scene is named " + name +
                              "; there are sphere, hall, terrain, field");
}

BenchScene sphere_scene(std::size_t triangles) {
  return named_sphere("sphere " + std::to_string(triangles), triangles);
}

BenchScene scene_from_file(const std::string& path) {
  const Scene scene = load_scene(path).scene;
  Mesh all;
  const auto add = [&](const Triangle& triangle) {
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    for (const Vec3& p : {triangle.a, triangle.b, triangle.c}) all.positions.push_back(p);
    all.triangles.push_back({first, first + 1, first + 2});
  };
  Primitives(scene).for_each([&](PrimitiveId, const auto& shape) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(shape)>, Triangle>) add(shape);
  });
  if (all.triangles.empty()) throw std::invalid_argument(path + " has no triangles");
  DVec3 lo(all.positions[0]), hi = lo;
  for (const Vec3& p : all.positions) {
    lo = glm::min(lo, DVec3(p));
    hi = glm::max(hi, DVec3(p));
  }
  const DVec3 direction = DVec3(-0.6, -0.35, -0.7) * glm::length(hi - lo);
  const Pose pose{.position = (lo + hi) / 2.0 - direction, .direction = direction};
  return make_scene(std::filesystem::path(path).stem(), std::move(all), pose, 45);
}

}  // namespace microtrace::bench

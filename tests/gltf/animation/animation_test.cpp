#include "gltf/asset_builder.hpp"
#include "io/gltf/scene/scene.hpp"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Vec3 corner(const LoadedScene& loaded, std::size_t number = 7) {
  return std::get<Mesh>(loaded.scene.objects.at(0).shape).positions[number];
}

Vec3 corner_at(const AssetBuilder& asset, double time, const char* animation = "") {
  return corner(load(asset, {.time = time, .animation = animation}));
}

void expect_near(const Vec3& value, const Vec3& wanted) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(value[i], wanted[i], 1e-6) << i;
}

/// Returns a cube that makes one full rotation about z between 1 and 3 seconds, in four quarter
/// turns, and moves by 10 along x.
AssetBuilder turning_cube() {
  AssetBuilder asset = cube();
  const float half = std::sqrt(0.5F);
  const std::size_t input = asset.add_numbers<float>("SCALAR", {1, 1.5F, 2, 2.5F, 3});
  const std::size_t turns = asset.add_numbers<float>(
      "VEC4", {0, 0, 0, 1, 0, 0, half, half, 0, 0, 1, 0, 0, 0, half, -half, 0, 0, 0, -1});
  const std::size_t ends = asset.add_numbers<float>("SCALAR", {1, 3});
  const std::size_t moves = asset.add_numbers<float>("VEC3", {0, 0, 0, 10, 0, 0});
  asset.animate(0, 0, "rotation", input, turns);
  asset.animate(0, 0, "translation", ends, moves);
  return asset;
}

TEST(GltfAnimation, CubeRotatesAboutZWhileItMoves) {
  const AssetBuilder asset = turning_cube();
  for (double time = 1; time <= 3; time += 0.0625) {
    const double angle = (time - 1) * std::numbers::pi, move = 5 * (time - 1);
    expect_near(corner_at(asset, time), Vec3(std::cos(angle) - std::sin(angle) + move,
                                             std::cos(angle) + std::sin(angle), 1));
  }
  EXPECT_THAT(texts(load(asset, {.time = 2}).warnings), IsEmpty());
}

TEST(GltfAnimation, WithoutATimeNothingIsAnimated) {
  AssetBuilder asset = turning_cube();
  asset.json["nodes"][0]["translation"] = {0, 0, 3};
  const LoadedScene rest = load(asset);
  EXPECT_EQ(corner(rest), Vec3(1, 1, 4));
  EXPECT_THAT(texts(rest.warnings), IsEmpty());
}

TEST(GltfAnimation, TimesAreClamped) {
  const AssetBuilder asset = turning_cube();
  EXPECT_EQ(corner_at(asset, 0), Vec3(1, 1, 1));
  EXPECT_EQ(corner_at(asset, -1e30), Vec3(1, 1, 1));
  EXPECT_EQ(corner_at(asset, 1e30), Vec3(11, 1, 1));
}

TEST(GltfAnimation, PropertiesWithoutAChannelKeepTheFilesValues) {
  AssetBuilder asset = cube();
  asset.json["nodes"][0].update({{"translation", {5, 0, 0}}, {"rotation", {0, 0, 1, 0}}});
  const std::size_t input = asset.add_numbers<float>("SCALAR", {0, 1});
  asset.animate(0, 0, "scale", input, asset.add_numbers<float>("VEC3", {1, 1, 1, 3, 5, 7}));
  EXPECT_EQ(corner_at(asset, 0.5), Vec3(3, -3, 4));
}

TEST(GltfAnimation, ChildrenMoveWithTheirParents) {
  AssetBuilder asset = turning_cube();
  asset.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 100}}});
  asset.json["nodes"][0]["children"] = {1};
  asset.json["nodes"][0].erase("mesh");
  expect_near(corner_at(asset, 2), Vec3(4, -1, 101));
}

TEST(GltfAnimation, StepAndCubicSplineAreRead) {
  AssetBuilder asset = cube();
  const std::size_t input = asset.add_numbers<float>("SCALAR", {0, 1});
  asset.animate(0, 0, "translation", input, asset.add_numbers<float>("VEC3", {0, 0, 0, 10, 0, 0}),
                "STEP");
  EXPECT_EQ(corner_at(asset, 0.99).x, 1);
  EXPECT_EQ(corner_at(asset, 1).x, 11);
  asset.json.erase("animations");
  // The in-tangents are 0 and then 8 along x. The out-tangents are 4 along y and then 0.
  asset.animate(0, 0, "translation", input,
                asset.add_numbers<float>("VEC3", {7, 7, 7, 0, 0, 0, 0, 4, 0,  //
                                                  8, 0, 0, 1, 1, 0, 7, 7, 7}),
                "CUBICSPLINE");
  const Vec3 p = corner_at(asset, 0.5) - Vec3(1);
  EXPECT_FLOAT_EQ(p.x, 0.5F - 1);     // 3 t^2 - 2 t^3 plus 8 (t^3 - t^2) at t = 1/2
  EXPECT_FLOAT_EQ(p.y, 0.5F + 0.5F);  // 3 t^2 - 2 t^3 plus 4 (t^3 - 2 t^2 + t) at t = 1/2
}

TEST(GltfAnimation, RotationsMayBeNormalizedIntegers) {
  const auto turned = [](auto one, auto zero) {
    AssetBuilder asset = cube();
    using Integer = decltype(one);
    const std::size_t input = asset.add_numbers<float>("SCALAR", {0, 1});
    asset.animate(
        0, 0, "rotation", input,
        asset.add_numbers<Integer>("VEC4", {zero, zero, zero, one, zero, zero, one, zero}, true));
    return corner_at(asset, 0.5);
  };
  expect_near(turned(std::int8_t{127}, std::int8_t{0}), Vec3(-1, 1, 1));
  expect_near(turned(std::int16_t{32767}, std::int16_t{0}), Vec3(-1, 1, 1));
  expect_near(turned(std::uint8_t{255}, std::uint8_t{0}), Vec3(-1, 1, 1));
  expect_near(turned(std::uint16_t{65535}, std::uint16_t{0}), Vec3(-1, 1, 1));
}

TEST(GltfAnimation, IsSelectedByNameOrIndexOrAll) {
  AssetBuilder asset = turning_cube();
  const std::size_t input = asset.add_numbers<float>("SCALAR", {0, 1});
  asset.animate(1, 0, "scale", input, asset.add_numbers<float>("VEC3", {1, 1, 1, 1, 1, 5}));
  asset.json["animations"][0]["name"] = "turn";
  asset.json["animations"][1]["name"] = "grow";
  EXPECT_EQ(corner_at(asset, 3), Vec3(11, 1, 1));
  EXPECT_EQ(corner_at(asset, 3, "turn"), Vec3(11, 1, 1));
  EXPECT_EQ(corner_at(asset, 3, "grow"), Vec3(1, 1, 5));
  EXPECT_EQ(corner_at(asset, 3, "1"), Vec3(1, 1, 5));
  EXPECT_EQ(corner_at(asset, 3, "all"), Vec3(11, 1, 5));
  asset.json["animations"][0]["name"] = "1";  // names take precedence over indices
  EXPECT_EQ(corner_at(asset, 3, "1"), Vec3(11, 1, 1));
  for (const char* wrong : {"run", "2", "-1", "0x0", " 1", "99999999999999999999999"}) {
    try {
      (void)load(asset, {.time = 0, .animation = wrong});
      ADD_FAILURE() << wrong;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_THAT(error.what(), AllOf(HasSubstr(wrong), HasSubstr("0 (1), 1 (grow)")));
    }
  }
}

TEST(GltfAnimation, TimeWithoutAnimationsGivesAWarning) {
  EXPECT_THAT(texts(load(cube(), {.time = 1}).warnings), ElementsAre(HasSubstr("no animation")));
}

TEST(GltfAnimation, OneFileGivesManyPoses) {
  const std::string bytes = turning_cube().glb();
  io::GltfFile file(bytes, "test.glb", "");
  EXPECT_EQ(corner(file.at(3)), Vec3(11, 1, 1));
  EXPECT_EQ(corner(file.at(0)), Vec3(1, 1, 1));
  EXPECT_EQ(corner(file.at(std::nullopt)), Vec3(1, 1, 1));
  EXPECT_EQ(corner(file.at(3)), Vec3(11, 1, 1));
}

TEST(GltfAnimation, UnplayableChannelsGiveWarnings) {
  AssetBuilder asset = turning_cube();
  Json& channels = asset.json["animations"][0]["channels"];
  channels[0]["target"]["path"] = "colour";
  EXPECT_THAT(texts(load(asset, {.time = 3}).warnings),
              testing::Contains(AllOf(HasSubstr("/animations/0/channels/0/target/path"),
                                      HasSubstr("\"colour\" is not supported"))));
  channels[0]["target"]["path"] = "rotation";
  channels[0]["target"].erase("node");  // ignored, as the specification requires
  EXPECT_THAT(texts(load(asset, {.time = 3}).warnings), IsEmpty());
  EXPECT_EQ(corner_at(asset, 3), Vec3(11, 1, 1));
}

TEST(GltfAnimation, PointersToNodesAreFollowed) {
  AssetBuilder asset = turning_cube();
  asset.json["extensionsUsed"] = {"KHR_animation_pointer"};
  asset.json["extensionsRequired"] = {"KHR_animation_pointer"};
  Json& target = asset.json["animations"][0]["channels"][1]["target"];
  const auto point_to = [&](const char* pointer) {
    target = {{"path", "pointer"},
              {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
  };
  point_to("/nodes/0/translation");
  EXPECT_EQ(corner_at(asset, 3), Vec3(11, 1, 1));
  EXPECT_THAT(texts(load(asset, {.time = 3}).warnings), IsEmpty());
  for (const char* other :
       {"/materials/1/alphaCutoff", "/nodes/1/translation", "/nodes/0", "/nodes/-1/scale",
        "/nodes//scale", "/nodes/0/extensions/KHR_node_visibility/visible", "", "/"}) {
    point_to(other);
    const LoadedScene loaded = load(asset, {.time = 3});
    EXPECT_EQ(corner(loaded), Vec3(1, 1, 1)) << other;
    EXPECT_THAT(texts(loaded.warnings),
                ElementsAre(HasSubstr("/target/extensions/KHR_animation_pointer/pointer: ")))
        << other;
  }
}

TEST(GltfAnimation, IgnoresUnplayableChannels) {
  AssetBuilder asset = turning_cube();
  const std::size_t first =
      asset.json["accessors"].size() - 4;  // times, rotations, end times, translations
  const auto with = [&](std::size_t accessor, const char* key, const Json& value) {
    AssetBuilder broken = asset;
    broken.json["accessors"][first + accessor][key] = value;
    const LoadedScene loaded = load(broken, {.time = 3});
    // The other channel still plays: the cube either moves without rotating or rotates without
    // moving.
    EXPECT_EQ(corner(loaded).x, accessor < 2 ? 11 : 1) << accessor << key;
    return texts(loaded.warnings);
  };
  using testing::Contains;
  EXPECT_THAT(with(0, "componentType", 5125),
              Contains(HasSubstr("/animations/0/samplers/0/input: ")));
  EXPECT_THAT(with(1, "type", "VEC3"), Contains(HasSubstr("/animations/0/samplers/0/output: ")));
  EXPECT_THAT(with(1, "count", 4),
              Contains(AllOf(HasSubstr("/animations/0/samplers/0/output: "),
                             HasSubstr("has 4 elements"), HasSubstr("must have 5"))));
  EXPECT_THAT(with(3, "componentType", 5122),
              Contains(HasSubstr("/animations/0/samplers/1/output: ")));
  AssetBuilder broken = asset;
  broken.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_THAT(texts(load(broken, {.time = 2}).warnings), Contains(HasSubstr("has a matrix")));
  EXPECT_EQ(corner_at(broken, 2), Vec3(1));
}

/// Animates the cube to these x positions at these times. Returns its x at `time`, minus 1.
float x_at(const std::vector<float>& times, const std::vector<float>& places, double time) {
  AssetBuilder asset = cube();
  std::vector<float> moves;
  for (const float x : places) moves.insert(moves.end(), {x, 0, 0});
  const std::size_t input = asset.add_numbers<float>("SCALAR", times);
  asset.json["accessors"][input].erase("min");  // JSON has no NaN
  asset.json["accessors"][input].erase("max");
  asset.animate(0, 0, "translation", input, asset.add_numbers<float>("VEC3", moves));
  for (const bool played : {false, true}) {
    const LoadedScene loaded = load(asset, {.time = played ? std::optional(time) : std::nullopt});
    EXPECT_THAT(texts(loaded.warnings), testing::Contains(HasSubstr("/accessors/2: ")));
    EXPECT_EQ(loaded.warnings.at(0).severity, Severity::error);
  }
  return corner_at(asset, time).x - 1;
}

TEST(GltfAnimation, IgnoresKeysOutOfOrder) {
  EXPECT_EQ(x_at({0, 1, 1, 2}, {0, 10, 70, 20}, 1), 10);
  EXPECT_EQ(x_at({0, 1, 1, 2}, {0, 10, 70, 20}, 1.5), 15);
  EXPECT_EQ(x_at({0, 2, 1, 4}, {0, 20, 70, 40}, 3), 30);
  EXPECT_EQ(x_at({1, 1}, {5, 6}, 1), 5);
  EXPECT_EQ(x_at({0, NAN, 2}, {0, 70, 20}, 1), 10);
  EXPECT_EQ(x_at({NAN, NAN}, {5, 6}, 1), 0);
  EXPECT_EQ(x_at({-1, 1}, {0, 10}, 0), 5);
}

TEST(GltfAnimation, IgnoresKeysWithNonFiniteValues) {
  AssetBuilder asset = cube();
  const std::size_t input = asset.add_numbers<float>("SCALAR", {0, 1, 2});
  asset.animate(0, 0, "translation", input,
                asset.add_numbers<float>("VEC3", {0, 0, 0, 1, NAN, 1, 2, 0, 0}));
  EXPECT_EQ(corner_at(asset, 1), Vec3(2, 1, 1));
}

TEST(GltfAnimation, InvalidPointersGiveWarnings) {
  AssetBuilder asset = turning_cube();
  asset.json["extensionsUsed"] = {"KHR_animation_pointer"};
  Json& target = asset.json["animations"][0]["channels"][1]["target"];
  const auto complaint = [&](const Json& value) {
    target = value;
    const LoadedScene loaded = load(asset, {.time = 3});
    const bool is_error =
        loaded.warnings.size() == 1 && loaded.warnings[0].severity == Severity::error;
    return is_error ? texts(loaded.warnings)[0] : "";
  };
  const auto pointer = [](const char* text) {
    return Json{{"path", "pointer"},
                {"extensions", {{"KHR_animation_pointer", {{"pointer", text}}}}}};
  };
  for (const char* text :
       {"", "nodes/0/scale", "/nodes/0/sc~2ale", "/nodes/0/scale~", "/nodes", "/nodes/1/scale",
        "/nodes/x/scale", "/cameras/0/perspective/yfov", "/"}) {
    EXPECT_THAT(complaint(pointer(text)), HasSubstr("/extensions/KHR_animation_pointer/pointer: "))
        << text;
  }
  Json both = pointer("/nodes/0/translation");
  both["node"] = 0;
  EXPECT_THAT(complaint(both), HasSubstr("/target/node: must be absent"));
  EXPECT_EQ(corner_at(asset, 3), Vec3(11, 1, 1));  // the pointer takes precedence
  both.erase("node");
  both["path"] = "translation";
  EXPECT_THAT(complaint(both), HasSubstr("/target/path: must be \"pointer\""));
  EXPECT_THAT(complaint({{"path", "pointer"}}), HasSubstr("/target/path: is \"pointer\" without"));
}

}  // namespace
}  // namespace microtrace::tests

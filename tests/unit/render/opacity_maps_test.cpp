// Compares the decisions about transparent points with those of the texture lookup.

#include "render/shading/opacity_maps.hpp"

#include "exact/first_hit.hpp"
#include "render/shading/shading.hpp"
#include "render/shading/texture_slots.hpp"
#include "render/textures/shared_textures.hpp"

#include <microtrace/primitives.hpp>

#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

class Random {
 public:
  /// Returns an integer in [0, n).
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(bits_() % n); }
  /// Returns a number in [lo, hi).
  float within(float lo, float hi) {
    return lo + (hi - lo) * (static_cast<float>(bits_() >> 8U) * 0x1p-24F);
  }
  template <class T>
  T one_of(std::initializer_list<T> values) {
    return values.begin()[below(static_cast<std::uint32_t>(values.size()))];
  }

 private:
  std::mt19937 bits_{7};
};

/// A picture of blobs, stripes, or noise, whose alpha often equals a cutoff.
std::uint32_t alpha_at(Random& random, int kind, std::uint32_t x, std::uint32_t y) {
  if (kind == 0) return random.one_of({0U, 128U, 255U});
  if (kind == 1) return x / 5 % 2 == 0 ? 255 : 0;
  if (kind == 2) return (x * x + y * y) % 200 < 120 ? 128 : 0;
  return (x + y) % 256;
}

Image random_image(Random& random) {
  Image image{.width = random.one_of({1U, 2U, 7U, 64U, 193U}),
              .height = random.one_of({1U, 3U, 64U, 150U}),
              .channels = random.one_of({1U, 2U, 3U, 4U, 4U, 4U})};
  const int kind = static_cast<int>(random.below(4));
  const bool is_wide = random.below(4) == 0;
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint16_t> words;
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
      for (std::uint32_t channel = 0; channel < image.channels; ++channel) {
        const std::uint32_t value = alpha_at(random, kind, x, y);
        bytes.push_back(static_cast<std::uint8_t>(value));
        words.push_back(static_cast<std::uint16_t>(257 * value));
      }
    }
  }
  if (is_wide)
    image.samples = words;
  else
    image.samples = bytes;
  return image;
}

Vec2 random_uv(Random& random, float size) {
  return {random.within(-size, size), random.within(-size, size)};
}

/// A mesh with triangles of many sizes in texture coordinates, some of them points or segments.
Mesh random_mesh(Random& random) {
  Mesh mesh;
  mesh.uv_sets.resize(random.one_of({0U, 1U, 2U, 2U, 2U}));
  const bool has_colors = random.below(3) == 0;
  for (std::uint32_t i = 0; i < 36; ++i) {
    const bool is_flat = i % 3 == 2 && random.below(10) == 0;  // without an area
    mesh.positions.push_back(
        is_flat ? mesh.positions[i - 1]
                : Vec3(random.within(-1, 1), random.within(-1, 1), random.within(-1, 1)));
    if (has_colors) mesh.colors.push_back({1, 1, 1, random.one_of({0.0F, 0.5F, 1.0F, 1.0F})});
    for (Array<Vec2>& uv : mesh.uv_sets) {
      const float size = random.one_of({0.0F, 0.01F, 1.0F, 1.0F, 5.0F, 3e4F, 1e7F});
      const bool is_copy = i / 3 % 3 == 1, repeats = i % 3 != 0 && random.below(8) == 0;
      uv.push_back(is_copy ? uv[i - 3] : repeats ? uv[i - 1] : random_uv(random, size));
    }
    if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
  }
  return mesh;
}

Scene random_scene(Random& random) {
  Scene scene;
  scene.images.push_back(std::make_shared<const Image>(random_image(random)));
  const auto wrap = [&] {
    return random.one_of({Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge});
  };
  scene.textures.push_back(
      {.image = 0,
       .sampler = {.wrap_s = wrap(),
                   .wrap_t = wrap(),
                   .magnification = random.one_of({Filter::nearest, Filter::linear})}});
  Material material{.alpha_mode = random.one_of({AlphaMode::mask, AlphaMode::blend}),
                    .alpha_cutoff = random.one_of({0.0F, 0.25F, 0.5F, 128 / 255.0F, 1.0F, 1.5F})};
  material.base_color.w = random.one_of({0.0F, 0.3F, 1.0F, 1.0F, 1.0F});
  if (random.below(8) != 0) {
    TextureUse& use = material.base_color_texture.emplace();
    use.uv_set = random.below(2);
    if (random.below(2) == 0)
      use.texture_from_uv = {{random.within(-2, 2), random.within(-2, 2)},
                             {random.within(-2, 2), random.within(-2, 2)},
                             random_uv(random, random.one_of({0.0F, 1.0F, 1000.0F}))};
  }
  scene.materials.push_back(material);
  scene.objects.push_back({.shape = random_mesh(random), .material = 0});
  return scene;
}

/// Barycentric coordinates, some on edges, at vertices, or on the boundaries of cells.
Vec3 random_barycentrics(Random& random) {
  DVec3 w(random.within(0, 1), random.within(0, 1), random.within(0, 1));
  if (random.below(4) == 0) w = glm::round(w * 64.0);
  if (random.below(8) == 0) w[static_cast<int>(random.below(3))] = 0;
  const double sum = w.x + w.y + w.z;
  return sum > 0 ? Vec3(w * (1 / sum)) : Vec3(0, 1, 0);
}

TEST(OpacityMaps, KnowOnlyWhatTheLookupFinds) {
  Random random;
  std::size_t transparent = 0, visible = 0, unknown = 0;
  for (int round = 0; round < 1500; ++round) {
    const Scene scene = random_scene(random);
    const Primitives primitives(scene);
    SharedTextures shared;
    const Shading shading(scene, primitives, shared);
    TextureMaps textures(scene, shared);
    const TexturedMaterial look = textures.slots(scene.materials[0]);
    const Mesh& mesh = std::get<Mesh>(scene.objects[0].shape);
    OpacityMaps maps;
    const std::size_t first = maps.add(mesh, look);
    for (PrimitiveId id = 0; id < mesh.triangles.size(); ++id) {
      const Triangle t = *primitives.triangle(id);
      if (t.b == t.c) continue;  // point_on() does not interpolate on triangles without an area
      for (int i = 0; i < 60; ++i) {
        const Vec3 barycentrics = random_barycentrics(random);
        const ShadingPoint point = shading.point_on(id, barycentrics, true, 0);
        const bool is_transparent = shading.coverage(point, false) == 0;
        const Opacity opacity = maps.at(first + id, barycentrics.y, barycentrics.z);
        unknown += opacity == Opacity::unknown ? 1 : 0;
        if (opacity == Opacity::unknown) continue;
        (is_transparent ? transparent : visible) += 1;
        ASSERT_EQ(opacity == Opacity::transparent, is_transparent)
            << "scene " << round << ", triangle " << id << ", barycentrics " << barycentrics.x
            << ' ' << barycentrics.y << ' ' << barycentrics.z;
      }
    }
  }
  // Many of these textures differ from texel to texel.
  EXPECT_GT(transparent, 100000U);
  EXPECT_GT(visible, 200000U);
  EXPECT_LT(unknown, 500000U);
}

// Each cell has half the size of a texel. Every other cell ends just before the boundary of two
// texels, but the lookup rounds coordinates near 1000.
TEST(OpacityMaps, ReckonWithTheRoundingOfTextureCoordinates) {
  std::vector<std::uint8_t> samples;
  for (int i = 0; i < 10; ++i)
    samples.insert(samples.end(), {255, i % 2 == 0 ? std::uint8_t{255} : std::uint8_t{0}});
  Scene scene;
  scene.images.push_back(std::make_shared<const Image>(
      Image{.width = 10, .height = 1, .channels = 2, .samples = samples}));
  scene.textures.push_back({.image = 0, .sampler = {.magnification = Filter::nearest}});
  Material& material = scene.materials.emplace_back();
  material.alpha_mode = AlphaMode::mask;
  material.base_color_texture.emplace().texture_from_uv = {{1, 0}, {0, 1}, {1000, 0}};
  const float end = 1.599984F;
  Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
  mesh.uv_sets.push_back({{0, 0}, {end, 0}, {0, 1}});
  scene.objects.push_back({.shape = mesh, .material = 0});
  const Primitives primitives(scene);
  SharedTextures shared;
  const Shading shading(scene, primitives, shared);
  TextureMaps textures(scene, shared);
  OpacityMaps maps;
  const std::size_t map = maps.add(mesh, textures.slots(scene.materials[0]));
  int known = 0;
  for (int k = 0; k < 16; ++k) {
    for (const float offset : {0.0F, 0x1p-20F, 0.03F, 0x1p-4F - 0x1p-20F}) {
      const float w = static_cast<float>(k) / 16 + offset;
      const Vec3 at(1 - w, w, 0);
      const Opacity opacity = maps.at(map, at.y, at.z);
      if (opacity == Opacity::unknown) continue;
      ++known;
      const float coverage = shading.coverage(shading.point_on(0, at, true, 0), false);
      EXPECT_EQ(opacity == Opacity::transparent, coverage == 0) << k << ' ' << offset;
    }
  }
  EXPECT_EQ(known, 0);  // all cells touch both kinds of texels within rounding
}

TEST(OpacityMaps, KnowMostOfALeaf) {
  constexpr std::uint32_t kSize = 64;
  std::vector<std::uint8_t> samples;
  for (std::uint32_t i = 0; i < kSize * kSize; ++i) {
    const float x = static_cast<float>(i % kSize) - 31.5F,
                y = static_cast<float>(i / kSize) - 31.5F;
    samples.insert(samples.end(),
                   {40, 120, 20, x * x + 2 * y * y < 800 ? std::uint8_t{255} : std::uint8_t{0}});
  }
  Scene scene;
  scene.images.push_back(std::make_shared<const Image>(
      Image{.width = kSize, .height = kSize, .channels = 4, .samples = samples}));
  scene.textures.push_back({.image = 0});
  scene.materials.push_back({.base_color_texture = TextureUse{}, .alpha_mode = AlphaMode::mask});
  SharedTextures shared;
  TextureMaps textures(scene, shared);
  const TexturedMaterial look = textures.slots(scene.materials[0]);
  Mesh quad{.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
            .triangles = {{0, 1, 2}, {0, 2, 3}}};
  quad.uv_sets.push_back({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  OpacityMaps maps;
  const std::size_t first = maps.add(quad, look);
  EXPECT_EQ(maps.add(quad, look), first);  // an instance shares the maps
  Random random;
  int unknown = 0;
  for (std::size_t i = 0; i < 2000; ++i) {
    const Vec3 at = random_barycentrics(random);
    unknown += maps.at(first + i % 2, at.y, at.z) == Opacity::unknown ? 1 : 0;
  }
  EXPECT_LT(unknown, 400);
}

/// A ray toward a point of a triangle, often nearly within its plane.
Ray random_ray(Random& random, const Triangle& t, const Vec3& barycentrics) {
  const Vec3 target = barycentrics.x * t.a + barycentrics.y * t.b + barycentrics.z * t.c;
  Vec3 d(random.within(-1, 1), random.within(-1, 1), random.within(-1, 1));
  if (random.below(3) == 0) d = (t.b - t.a) + d * random.one_of({1e-3F, 1e-6F, 1e-8F});
  return {.o = target - d * random.within(0, 8), .d = d};
}

TEST(MaskedTriangles, AreTransparentWhereTheirCoverageIsZero) {
  Random random;
  std::size_t transparent = 0, visible = 0;
  for (int round = 0; round < 800; ++round) {
    const Scene scene = random_scene(random);
    const Primitives primitives(scene);
    SharedTextures shared;
    const Shading shading(scene, primitives, shared);
    for (PrimitiveId id = 0; id < primitives.count(); ++id) {
      for (int i = 0; i < 40; ++i) {
        const Ray ray = random_ray(random, *primitives.triangle(id), random_barycentrics(random));
        if (!exact::first_hit(*primitives.triangle(id), ray)) continue;
        const ShadingPoint point = shading.point(ray, {.id = id, .t = 1});
        const bool is_masked = shading.masked() != nullptr && shading.is_masked(id);
        // Edge-on triangles have no texture coordinates.
        if (!is_masked && !point.at.mesh) continue;
        const bool expected = shading.coverage(point.unfiltered(), false) == 0;
        const bool found = is_masked && shading.is_transparent(ray, id);
        ASSERT_EQ(found, expected) << "scene " << round << ", triangle " << id;
        (expected ? transparent : visible) += 1;
      }
    }
  }
  EXPECT_GT(transparent, 50000U);
  EXPECT_GT(visible, 50000U);
}

TEST(MaskedTriangles, AreThoseOfMeshesThatAreTransparentInPlaces) {
  Scene scene;
  scene.materials.push_back({.base_color = {1, 1, 1, 0.75F}, .alpha_mode = AlphaMode::mask});
  scene.materials.push_back({.base_color = {1, 1, 1, 0.25F}, .alpha_mode = AlphaMode::mask});
  scene.materials.push_back({.base_color = {1, 1, 1, 0}, .alpha_mode = AlphaMode::blend});
  scene.materials.push_back({.base_color = {1, 1, 1, 0}});
  const Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
  for (std::uint32_t i = 0; i < 4; ++i) scene.objects.push_back({.shape = mesh, .material = i});
  scene.objects.push_back({.shape = Sphere{.center = {0, 0, 0}, .radius = 1}, .material = 1});
  const Primitives primitives(scene);
  SharedTextures shared;
  const Shading shading(scene, primitives, shared);
  EXPECT_FALSE(shading.is_masked(0));
  EXPECT_TRUE(shading.is_masked(1));
  EXPECT_TRUE(shading.is_masked(2));
  EXPECT_FALSE(shading.is_masked(3));
  EXPECT_FALSE(shading.is_masked(4));
  EXPECT_TRUE(shading.blocks_unless_transparent(0));
  EXPECT_TRUE(shading.blocks_unless_transparent(1));
  EXPECT_FALSE(shading.blocks_unless_transparent(2));
  EXPECT_TRUE(shading.blocks_unless_transparent(3));
  EXPECT_FALSE(shading.blocks_unless_transparent(4));
}

}  // namespace
}  // namespace microtrace

#include "io/gltf/materials.hpp"

#include "io/gltf/extension.hpp"
#include "scene/trigonometry.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

namespace microtrace::io::gltf {
namespace {

float number(const JsonValue& object, std::string_view key, float standard) {
  const JsonValue* value = object.find(key);
  return value != nullptr ? static_cast<float>(value->number) : standard;
}

/// A vector of as many numbers as the schema asks for there.
template <typename Vector>
Vector vector(const JsonValue& object, std::string_view key, const Vector& standard) {
  const JsonValue* value = object.find(key);
  if (value == nullptr) return standard;
  Vector result(0);
  for (glm::length_t i = 0; i < Vector::length(); ++i) {
    result[i] = static_cast<float>(value->items[static_cast<std::size_t>(i)].number);
  }
  return result;
}

std::uint32_t index(const JsonValue& object, std::string_view key) {
  const JsonValue* value = object.find(key);
  return value != nullptr ? static_cast<std::uint32_t>(value->number) : 0;
}

std::string name_of(const JsonValue& object) {
  const JsonValue* name = object.find("name");
  return name != nullptr ? name->string : std::string();
}

/// KHR_texture_transform: scaled, turned anticlockwise as seen with v going down, moved.
Mat3x2 texture_transform(const JsonValue& json) {
  const Vec2 offset = vector(json, "offset", Vec2(0)), scale = vector(json, "scale", Vec2(1));
  const JsonValue* rotation = json.find("rotation");
  // The trigonometry ends at 2^20; that so large an angle turns by is anyone's guess.
  const double angle = rotation != nullptr ? std::fmod(rotation->number, 2 * std::numbers::pi) : 0;
  const double sine = sin_radians(angle), cosine = cos_radians(angle);
  return {Vec2(cosine * scale.x, -sine * scale.x), Vec2(sine * scale.y, cosine * scale.y), offset};
}

/// The textureInfo of that name, if the object has one.
std::optional<TextureUse> texture_use(const JsonValue& object, std::string_view key) {
  const JsonValue* info = object.find(key);
  if (info == nullptr) return std::nullopt;
  TextureUse use{.texture = index(*info, "index"), .uv_set = index(*info, "texCoord")};
  if (const JsonValue* transform = extension(*info, "KHR_texture_transform")) {
    use.texture_from_uv = texture_transform(*transform);
    if (transform->find("texCoord") != nullptr) use.uv_set = index(*transform, "texCoord");
  }
  return use;
}

AlphaMode alpha_mode(const JsonValue& material) {
  const JsonValue* mode = material.find("alphaMode");
  if (mode == nullptr || mode->string == "OPAQUE") return AlphaMode::opaque;
  return mode->string == "MASK" ? AlphaMode::mask : AlphaMode::blend;
}

Material standard_material() {
  Material material;
  material.double_sided = false;
  material.metallic = 1;
  return material;
}

void read_metallic_roughness(const JsonValue& pbr, Material& material) {
  material.base_color = vector(pbr, "baseColorFactor", material.base_color);
  material.base_color_texture = texture_use(pbr, "baseColorTexture");
  material.metallic = number(pbr, "metallicFactor", 1);
  material.roughness = number(pbr, "roughnessFactor", 1);
  material.metallic_roughness_texture = texture_use(pbr, "metallicRoughnessTexture");
}

/// What the metallic model can take of it: the diffuse part.
void read_specular_glossiness(const JsonValue& json, Material& material) {
  material.base_color = vector(json, "diffuseFactor", material.base_color);
  material.base_color_texture = texture_use(json, "diffuseTexture");
  material.metallic = 0;
  material.roughness = 1 - number(json, "glossinessFactor", 1);
}

Material make_material(const JsonValue& json) {
  Material material = standard_material();
  material.name = name_of(json);
  if (const JsonValue* pbr = json.find("pbrMetallicRoughness")) {
    read_metallic_roughness(*pbr, material);
  } else if (const JsonValue* archived = extension(json, "KHR_materials_pbrSpecularGlossiness")) {
    read_specular_glossiness(*archived, material);
  }
  material.alpha_mode = alpha_mode(json);
  material.alpha_cutoff = number(json, "alphaCutoff", 0.5F);
  const JsonValue* double_sided = json.find("doubleSided");
  material.double_sided = double_sided != nullptr && double_sided->boolean;
  material.unlit = extension(json, "KHR_materials_unlit") != nullptr;
  material.normal_texture = texture_use(json, "normalTexture");
  if (material.normal_texture)
    material.normal_scale = number(*json.find("normalTexture"), "scale", 1);
  material.occlusion_texture = texture_use(json, "occlusionTexture");
  if (material.occlusion_texture) {
    material.occlusion_strength = number(*json.find("occlusionTexture"), "strength", 1);
  }
  material.emissive = vector(json, "emissiveFactor", material.emissive);
  material.emissive_texture = texture_use(json, "emissiveTexture");
  return material;
}

Wrap wrap(const JsonValue& sampler, std::string_view key) {
  const JsonValue* mode = sampler.find(key);
  if (mode == nullptr || mode->number == 10497) return Wrap::repeat;
  return mode->number == 33071 ? Wrap::clamp_to_edge : Wrap::mirrored_repeat;
}

/// OpenGL's numbers: odd ones filter the image linearly; from 9984 on with mip maps, and from 9986
/// on linearly between these.
Sampler make_sampler(const JsonValue& json) {
  Sampler sampler{.wrap_s = wrap(json, "wrapS"), .wrap_t = wrap(json, "wrapT")};
  const auto filter = [](int name) { return name % 2 == 0 ? Filter::nearest : Filter::linear; };
  sampler.magnification = filter(static_cast<int>(number(json, "magFilter", 9729)));
  const int minification = static_cast<int>(number(json, "minFilter", 9987));
  sampler.minification = filter(minification);
  if (minification < 9986) {
    sampler.mip = minification < 9984 ? MipFilter::none : MipFilter::nearest;
  }
  return sampler;
}

}  // namespace

std::vector<Material> make_materials(const Asset& asset) {
  std::vector<Material> materials;
  for (const JsonValue& json : asset.array("materials")) materials.push_back(make_material(json));
  materials.push_back(standard_material());
  return materials;
}

std::vector<Texture> make_textures(Asset& asset) {
  std::vector<Texture> textures;
  for (const JsonValue& json : asset.array("textures")) {
    Texture texture{.name = name_of(json)};
    const JsonValue* webp = extension(json, "EXT_texture_webp");
    if (webp != nullptr && webp->find("source") != nullptr) {
      texture.image = index(*webp, "source");
    } else if (json.find("source") != nullptr) {
      texture.image = index(json, "source");
    } else {
      asset.warn(asset.element("textures", textures.size()),
                 "has no image in PNG, JPEG or WebP; it is white");
    }
    if (const JsonValue* sampler = json.find("sampler")) {
      texture.sampler =
          make_sampler(asset.array("samplers")[static_cast<std::size_t>(sampler->number)]);
    }
    textures.push_back(std::move(texture));
  }
  return textures;
}

}  // namespace microtrace::io::gltf

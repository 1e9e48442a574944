#include "gltf/rig.hpp"

namespace microtrace::tests {
namespace {

/// A PNG image of one pixel, 8-bit RGB.
constexpr unsigned char kPng[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
    0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00,
    0x00, 0x90, 0x77, 0x53, 0xde, 0x00, 0x00, 0x00, 0x0c, 0x49, 0x44, 0x41, 0x54, 0x78,
    0x9c, 0x63, 0xf8, 0xdf, 0xe0, 0x00, 0x00, 0x04, 0x41, 0x01, 0xc0, 0x0c, 0xd1, 0xed,
    0x91, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

template <typename Number>
std::size_t add_accessor(AssetBuilder& asset, const char* type, int component,
                         std::size_t components, const std::vector<Number>& numbers) {
  const std::size_t view = asset.add_view(bytes_of(numbers));
  return asset.add("accessors", {{"bufferView", view},
                                 {"componentType", component},
                                 {"count", numbers.size() / components},
                                 {"type", type}});
}

void add_accessors(AssetBuilder& asset) {
  asset.add_positions({Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)});
  add_accessor<float>(asset, "VEC3", kFloat32, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  add_accessor<float>(asset, "VEC4", kFloat32, 4, {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1});
  add_accessor<float>(asset, "VEC2", kFloat32, 2, {0, 0, 1, 0, 0, 1});
  add_accessor<float>(asset, "VEC3", kFloat32, 3, {1, 1, 1, 0, 0, 0, 1, 0, 0});
  add_accessor<std::uint8_t>(asset, "VEC4", kUint8, 4, {0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0});
  add_accessor<float>(asset, "VEC4", kFloat32, 4,
                      {0.5F, 0.5F, 0, 0, 0.25F, 0.75F, 0, 0, 1, 0, 0, 0});
  asset.add_positions({Vec3(0, 0, 1), Vec3(0), Vec3(0)});
  asset.add_indices({0, 1, 2}, kUint16);
  std::vector<float> identities;
  for (int i = 0; i < 32; ++i) identities.push_back(i % 16 % 5 == 0 ? 1.0F : 0.0F);
  add_accessor<float>(asset, "MAT4", kFloat32, 16, identities);
  add_accessor<float>(asset, "SCALAR", kFloat32, 1, {0, 1});
  asset.json["accessors"][rig_times]["min"] = {0};
  asset.json["accessors"][rig_times]["max"] = {1};
  add_accessor<float>(asset, "VEC3", kFloat32, 3, {0, 0, 0, 1, 2, 3});
  add_accessor<float>(asset, "VEC4", kFloat32, 4, {0, 0, 0, 1, 0, 0, 1, 0});
  add_accessor<float>(asset, "SCALAR", kFloat32, 1, {0, 1});
}

void add_animation(AssetBuilder& asset) {
  const auto channel = [](int number, int node, const char* path) {
    return Json{{"sampler", number}, {"target", {{"node", node}, {"path", path}}}};
  };
  const auto sampler = [](std::size_t output) {
    return Json{{"input", rig_times}, {"output", output}};
  };
  asset.add("animations",
            {{"channels",
              {channel(0, 1, "translation"), channel(1, 1, "rotation"), channel(2, 0, "weights")}},
             {"samplers",
              {sampler(rig_translations), sampler(rig_rotations), sampler(rig_morph_weights)}}});
}

void add_material(AssetBuilder& asset) {
  const std::size_t view =
      asset.add_view(std::string_view(reinterpret_cast<const char*>(kPng), sizeof kPng));
  asset.add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
  asset.add("samplers", Json::object());
  asset.add("textures", {{"source", 0}, {"sampler", 0}});
  asset.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                          {"extensions", {{"KHR_materials_ior", {{"ior", 1.25}}}}}});
}

}  // namespace

AssetBuilder rig() {
  AssetBuilder asset;
  add_accessors(asset);
  asset.add_object(
      {{"attributes",
        {{"POSITION", rig_positions},
         {"NORMAL", rig_normals},
         {"TANGENT", rig_tangents},
         {"TEXCOORD_0", rig_texcoords},
         {"COLOR_0", rig_colors},
         {"JOINTS_0", rig_joints},
         {"WEIGHTS_0", rig_weights}}},
       {"indices", rig_indices},
       {"material", 0},
       {"targets", {{{"POSITION", rig_displacements}}}},
       {"extensions",
        {{"KHR_materials_variants",
          {{"mappings",
            {{{"material", 0}, {"variants", {0}}}, {{"material", 0}, {"variants", {1}}}}}}}}}});
  asset.json["nodes"][0]["skin"] = 0;
  asset.add("nodes", {{"children", {2}}});
  asset.add("nodes", Json::object());
  asset.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  asset.json["scenes"][0]["nodes"] = {0, 1, 3};
  asset.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", rig_matrices}, {"skeleton", 1}});
  add_animation(asset);
  add_material(asset);
  asset.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_ior",
                                  "KHR_materials_variants"};
  asset.json["extensions"] = {
      {"KHR_lights_punctual",
       {{"lights", {{{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}}}}}}}},
      {"KHR_materials_variants", {{"variants", {{{"name", "day"}}, {{"name", "night"}}}}}}};
  return asset;
}

}  // namespace microtrace::tests

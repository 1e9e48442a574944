#include "io/gltf/draco.hpp"

#include "base/memory_account.hpp"
#include "io/gltf/draco_abi.hpp"
#include "io/gltf/extension.hpp"
#include "io/module_function.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <new>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {
namespace {

constexpr const char* name_of_extension = "KHR_draco_mesh_compression";
/// No mesh is packed more densely: regular grids take a hundredth of a bit for a triangle.
constexpr std::size_t most_triangles_per_byte = 1024;
constexpr std::size_t id_of_indices = ~std::size_t{0};

std::size_t components(int type) {
  return static_cast<std::size_t>(
      tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
}

/// Indices as elements of an accessor.
std::string narrowed(const std::vector<std::uint32_t>& indices, std::size_t size) {
  std::string result(indices.size() * size, '\0');
  for (std::size_t i = 0; i < indices.size(); ++i) {
    std::memcpy(&result[i * size], &indices[i], size);  // little-endian: the low bytes come first
  }
  return result;
}

/// Keeps a copy: the text may be an exception's own.
void keep(void* context, const char* text) {
  try {
    *static_cast<std::string*>(context) = text;
  } catch (const std::bad_alloc&) {
    // Without a reason it is an error too.
  }
}

const ModuleFunction& draco_function() {
  static const ModuleFunction function =
      find_module_function(draco_module_file_name, decode_draco_name);
  return function;
}

}  // namespace

/// What is to be decoded into which accessors.
struct DracoDecoder::Job {
  Element at;
  std::size_t view = 0;
  std::string_view bytes{};
  int indices = 0;  // the accessor
  std::size_t triangles = 0, points = 0;
  std::vector<int> accessors{};  // of the attributes
  std::vector<MicrotraceDracoAttribute> attributes{};
  std::map<int, Source> sources{};
};

bool DracoDecoder::decode(const Element& primitive_at, const tinygltf::Primitive& primitive) {
  const auto at = extension(primitive_at, name_of_extension);
  if (!at) return false;
  const std::size_t view = index(asset_, *at, "bufferView", model_.bufferViews.size());
  const auto bytes = views_.bytes(static_cast<int>(view));
  if (!bytes || !has_module(*at)) return false;
  if (primitive.indices < 0) asset_.fail(primitive_at, "lacks the indices that Draco fills");

  Job job{.at = *at, .view = view, .bytes = *bytes, .indices = primitive.indices};
  plan(primitive, job);
  const bool is_done = std::ranges::all_of(job.sources, [this](const auto& source) {
    const auto before = sources_.find(source.first);
    return before != sources_.end() && before->second == source.second;
  });
  if (!is_done) run(job);
  return true;
}

bool DracoDecoder::has_module(const Element& at) {
  if (draco_function().address != nullptr) return true;
  const std::string message =
      "KHR_draco_mesh_compression can't be decoded: " + draco_function().complaint +
      "; install libdraco-dev and build the target microtrace_draco";
  if (asset_.requires_extension(name_of_extension)) {
    asset_.fail(at, message, ErrorKind::unsupported);
  }
  asset_.warn(at, message);
  return false;
}

void DracoDecoder::plan(const tinygltf::Primitive& primitive, Job& job) const {
  const char* too_much = "can't hold as many indices and vertices as the accessors say";
  const std::size_t count = accessor(job.indices).count;
  job.triangles = count / 3;
  if (count % 3 != 0 || job.triangles / most_triangles_per_byte > job.bytes.size()) {
    asset_.fail(job.at, too_much);
  }
  job.sources.emplace(job.indices, Source(job.view, id_of_indices));
  const Element names = job.at.member("attributes");
  for (const JsonMember& member : names.value->members) {
    const auto attribute = primitive.attributes.find(member.key);
    if (attribute == primitive.attributes.end()) continue;
    const std::size_t id = whole_number(asset_, names, member.key, 0xFFFFFFFF);
    const tinygltf::Accessor& target = accessor(attribute->second);
    if (job.attributes.empty()) job.points = target.count;
    if (job.points != target.count) asset_.fail(job.at, "has attributes of different counts");
    if (components(target.type) > 4) asset_.fail(names.member(member.key), "is of matrices");
    if (job.points > 3 * job.triangles) asset_.fail(job.at, too_much);
    if (!job.sources.emplace(attribute->second, Source(job.view, id)).second) continue;
    job.accessors.push_back(attribute->second);
    job.attributes.push_back({.id = static_cast<std::uint32_t>(id),
                              .components = static_cast<std::uint32_t>(components(target.type)),
                              .type = static_cast<std::uint32_t>(target.componentType),
                              .values = nullptr});
  }
}

void DracoDecoder::charge(const Job& job, std::size_t count, std::size_t size) {
  if (count > left_ / size) {
    asset_.fail(job.at, "brings the decompressed meshes to more than 4 GiB, the most that is read",
                ErrorKind::limit);
  }
  left_ -= count * size;
  take_memory(count * size, "decompressed meshes");
}

void DracoDecoder::run(Job& job) {
  charge(job, 3 * job.triangles, 2 * sizeof(std::uint32_t));
  std::vector<std::string> values;
  for (std::size_t i = 0; i < job.attributes.size(); ++i) {
    const tinygltf::Accessor& target = accessor(job.accessors[i]);
    const std::size_t size = element_size(target.type, target.componentType);
    charge(job, job.points, size);
    values.emplace_back(job.points * size, '\0');
  }
  for (std::size_t i = 0; i < values.size(); ++i) job.attributes[i].values = values[i].data();
  std::vector<std::uint32_t> corners(3 * job.triangles);
  const MicrotraceDraco mesh{.bytes = job.bytes.data(),
                             .size = job.bytes.size(),
                             .triangles = job.triangles,
                             .points = job.points,
                             .indices = corners.data(),
                             .attributes = job.attributes.data(),
                             .attribute_count = job.attributes.size()};
  // What Draco itself needs.
  const MemoryAccount work = temporary_memory(job.triangles * 200, "decompressing meshes");
  std::string complaint;
  const auto decode_draco = reinterpret_cast<MicrotraceDecodeDraco>(draco_function().address);
  if (decode_draco(&mesh, keep, &complaint) == 0) {
    asset_.fail(job.at, "can't be decoded: " + complaint);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    reader_.replace(job.accessors[i], std::move(values[i]));
  }
  reader_.replace(job.indices,
                  narrowed(corners, component_size(accessor(job.indices).componentType)));
  for (const auto& [replaced, source] : job.sources) sources_[replaced] = source;
}

const tinygltf::Accessor& DracoDecoder::accessor(int index) const {
  return model_.accessors[static_cast<std::size_t>(index)];
}

}  // namespace microtrace::io::gltf

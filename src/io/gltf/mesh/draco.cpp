#include "io/gltf/mesh/draco.hpp"

#include "base/memory_account.hpp"
#include "io/gltf/document/extension.hpp"
#include "io/gltf/mesh/draco_abi.hpp"
#include "io/module_function.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {
namespace {

constexpr const char* kExtensionName = "KHR_draco_mesh_compression";
/// The maximum compression ratio. Regular grids need only a hundredth of a bit per triangle.
constexpr std::size_t kMaxTrianglesPerByte = 1024;
constexpr std::size_t kIdOfIndices = ~std::size_t{0};

/// Converts indices to the component size of an accessor.
std::string narrowed(const std::vector<std::uint32_t>& indices, std::size_t size) {
  std::string result(indices.size() * size, '\0');
  for (std::size_t i = 0; i < indices.size(); ++i) {
    std::memcpy(&result[i * size], &indices[i], size);  // copies the low bytes, which come first
  }
  return result;
}

const ModuleFunction& draco_function() {
  static const ModuleFunction function =
      find_module_function(kDracoModuleFileName, kDecodeDracoName);
  return function;
}

}  // namespace

/// One mesh to decode: its accessors and the decoded data.
struct DracoDecoder::Job {
  Element at;
  std::size_t view = 0;
  std::size_t indices = 0;               // accessor index
  std::vector<std::size_t> accessors{};  // accessor index of each attribute
  std::vector<std::size_t> sizes{};      // bytes per element of each attribute
  std::vector<MicrotraceDracoAttribute> attributes{};
  std::map<std::size_t, Source> sources{};
  MicrotraceDraco mesh{};
  std::size_t left = 0;  // remaining limit in bytes
  std::vector<std::uint32_t> corners{};
  std::vector<std::string> values{};
  std::optional<MemoryAccount> work{};
  std::string complaint{};
  bool is_too_large = false;

  /// Reserves memory for Draco's working data.
  bool reserve(std::size_t triangles) {
    work.emplace(temporary_memory(triangles * 200, "decompressing meshes"));
    return true;
  }

  /// Allocates the decoded mesh. Returns false if it is too large.
  bool prepare(std::size_t triangles, std::size_t points) {
    std::size_t bytes = triangles * kBytesOfTriangle;
    for (const std::size_t size : sizes) bytes += points * size;
    is_too_large = bytes > left;
    if (is_too_large) return false;
    left -= bytes;
    take_memory(bytes, "decompressed meshes");
    corners.resize(3 * triangles);
    mesh.indices = corners.data();
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      attributes[i].values = values.emplace_back(points * sizes[i], '\0').data();
    }
    return true;
  }

  /// The size of a triangle's three indices, which are stored twice: as decoded, and converted for
  /// the accessor.
  static constexpr std::size_t kBytesOfTriangle = sizeof(std::uint32_t) * 3 * 2;
};

namespace {

/// Keeps exceptions from crossing the C interface.
template <typename Job>
int prepare_job(void* job, std::size_t triangles, std::size_t points) {
  try {
    return static_cast<Job*>(job)->prepare(triangles, points) ? 1 : 0;
  } catch (const std::exception&) {
    static_cast<Job*>(job)->is_too_large = true;
    return 0;
  }
}

template <typename Job>
int reserve_for_job(void* job, std::size_t triangles) {
  try {
    return static_cast<Job*>(job)->reserve(triangles) ? 1 : 0;
  } catch (const std::exception&) {
    static_cast<Job*>(job)->is_too_large = true;
    return 0;
  }
}

/// Stores a copy of the text, which may belong to an exception.
template <typename Job>
void keep_complaint(void* job, const char* text) {
  try {
    static_cast<Job*>(job)->complaint = text;
  } catch (const std::bad_alloc&) {
    // If there is no memory for a copy of the text, the failure is reported without a reason.
  }
}

}  // namespace

bool DracoDecoder::decode(const Element& primitive_at, const Model::Primitive& primitive) {
  const auto at = extension(primitive_at, kExtensionName);
  if (!at) return false;
  const std::size_t view = index(asset_, *at, "bufferView", model_.buffer_views.size());
  const auto bytes = views_.bytes(view);
  if (!bytes || !has_module(*at)) return false;
  if (!primitive.indices)
    asset_.fail(primitive_at, "lacks the indices accessor that compressed primitives need");

  Job job{.at = *at, .view = view, .indices = *primitive.indices, .left = left_};
  job.mesh.bytes = bytes->data();
  job.mesh.size = bytes->size();
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
  if (asset_.requires_extension(kExtensionName)) {
    asset_.fail(at, message, ErrorKind::unsupported);
  }
  asset_.warn(at, message);
  return false;
}

void DracoDecoder::plan(const Model::Primitive& primitive, Job& job) const {
  job.sources.emplace(job.indices, Source(job.view, kIdOfIndices));
  const Element names = job.at.member("attributes");
  for (const JsonMember& member : names.value->members()) {
    const auto attribute = primitive.attributes.find(member.key);
    if (attribute == primitive.attributes.end()) continue;
    const std::size_t id = whole_number(asset_, names, member.key, 0xFFFFFFFF);
    const Model::Accessor& target = accessor(attribute->second);
    if (component_count(target.type) > 4)
      asset_.fail(names.member(member.key), "has matrices as elements, which Draco can't compress");
    if (!job.sources.emplace(attribute->second, Source(job.view, id)).second) continue;
    job.accessors.push_back(attribute->second);
    job.sizes.push_back(element_size(target.type, target.component_type));
    job.attributes.push_back(
        {.id = static_cast<std::uint32_t>(id),
         .components = static_cast<std::uint32_t>(component_count(target.type)),
         .type = static_cast<std::uint32_t>(target.component_type),
         .values = nullptr});
  }
}

void DracoDecoder::run(Job& job) {
  job.mesh.most_triangles =
      std::min(job.mesh.size * kMaxTrianglesPerByte, job.left / Job::kBytesOfTriangle);
  job.mesh.attributes = job.attributes.data();
  job.mesh.attribute_count = job.attributes.size();
  const auto decode_draco = reinterpret_cast<MicrotraceDecodeDraco>(draco_function().address);
  if (decode_draco(&job.mesh, reserve_for_job<Job>, prepare_job<Job>, keep_complaint<Job>, &job) ==
      0) {
    if (!job.is_too_large) asset_.fail(job.at, "can't be decoded: " + job.complaint);
    asset_.fail(job.at,
                "brings the decompressed meshes to more than 4 GiB, the limit, or to "
                "more than fit in memory",
                ErrorKind::limit);
  }
  left_ = job.left;
  const std::size_t points = job.values.empty() ? 0 : job.values[0].size() / job.sizes[0];
  check_counts(job, points);
  for (std::size_t i = 0; i < job.values.size(); ++i) {
    reader_.replace(job.accessors[i], std::move(job.values[i]));
  }
  reader_.replace(job.indices,
                  narrowed(job.corners, component_size(accessor(job.indices).component_type)));
  for (const auto& [replaced, source] : job.sources) sources_[replaced] = source;
}

void DracoDecoder::check_counts(const Job& job, std::size_t points) const {
  const Model::Accessor& indices = accessor(job.indices);
  const std::uint64_t numbers = std::uint64_t{1} << 8 * component_size(indices.component_type);
  if (points >= numbers) {
    asset_.fail(job.at, "has " + std::to_string(points) +
                            " vertices, too many for the componentType of the indices accessor");
  }
  const auto differs = [&](std::size_t index) { return accessor(index).count != points; };
  if (indices.count == job.corners.size() && std::ranges::none_of(job.accessors, differs)) return;
  asset_.tolerate(job.at,
                  "holds " + std::to_string(job.corners.size()) + " indices and " +
                      std::to_string(points) +
                      " vertices, not as many as the accessors state; all of them are drawn");
}

const Model::Accessor& DracoDecoder::accessor(std::size_t index) const {
  return model_.accessors[index];
}

}  // namespace microtrace::io::gltf

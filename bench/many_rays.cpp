// Traces rays read from a file through a mesh read from files, and prints the processor seconds of
// Bvh::intersect on one thread. bench/python/compare.py runs this program.

#include "timing.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/scene.hpp>

#include <array>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace {

using namespace microtrace;

/// Reads a whole file as values of type T.
template <class T>
std::vector<T> read(const std::filesystem::path& path) {
  std::vector<T> values(std::filesystem::file_size(path) / sizeof(T));
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(T)));
  if (!file) throw std::runtime_error("can't read " + path.string());
  return values;
}

double trace(const char* positions, const char* triangles, const char* rays) {
  Mesh mesh;
  for (const Vec3& p : read<Vec3>(positions)) mesh.positions.push_back(p);
  for (const auto& t : read<std::array<std::uint32_t, 3>>(triangles)) mesh.triangles.push_back(t);
  Scene scene;
  scene.objects.push_back({.name = "mesh", .shape = std::move(mesh)});
  const Bvh bvh(scene);
  std::vector<Ray> all;
  for (const auto& r : read<std::array<float, 6>>(rays))
    all.push_back({.o = {r[0], r[1], r[2]}, .d = {r[3], r[4], r[5]}});
  std::vector<std::optional<Hit>> hits(all.size());
  bvh.intersect(all, hits);  // maps all memory before the measurement
  return bench::seconds(1, [&] { bvh.intersect(all, hits); });
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 4) throw std::invalid_argument("usage: bench_many_rays POSITIONS TRIANGLES RAYS");
    std::cout << trace(argv[1], argv[2], argv[3]) << '\n';
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}

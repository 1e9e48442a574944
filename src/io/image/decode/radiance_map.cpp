#include "base/memory_account.hpp"
#include "base/system/float_environment.hpp"
#include "io/file.hpp"
#include "io/image/decode/decode_colors.hpp"
#include "scene/math/srgb.hpp"

#include <microtrace/error.hpp>
#include <microtrace/io.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <new>
#include <string>
#include <variant>
#include <vector>

namespace microtrace {
namespace {

struct CountedMap {
  RadianceMap map;
  MemoryAccount memory;
};

/// Returns a table that converts all sRGB values of this integer type to linear light.
template <class Number>
std::vector<float> srgb_table() {
  constexpr std::size_t kCount = std::size_t{std::numeric_limits<Number>::max()} + 1;
  std::vector<float> table(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    table[i] = static_cast<float>(linear_from_srgb(static_cast<double>(i) / double{kCount - 1}));
  }
  return table;
}

/// Fills the pixels of the whole picture for which the file has samples. value(i) must return
/// sample i in linear light.
template <class Value>
void fill(const MicrotraceColors& colors, Value&& value, RadianceMap& map) {
  const std::size_t channels = colors.channels, step = channels < 3 ? 0 : 1;
  const auto begin = [](std::int32_t from) { return std::max(from, 0); };
  const auto end = [](std::int32_t from, std::uint32_t size, std::uint32_t whole) {
    return std::clamp<std::int64_t>(std::int64_t{from} + size, 0, whole);
  };
  for (std::int64_t y = begin(colors.y0); y < end(colors.y0, colors.height, map.height); ++y) {
    for (std::int64_t x = begin(colors.x0); x < end(colors.x0, colors.width, map.width); ++x) {
      const auto of_file = static_cast<std::size_t>((y - colors.y0) * colors.width + x - colors.x0);
      const std::size_t first = of_file * channels;
      map.pixels[static_cast<std::size_t>(y * map.width + x)] =
          Vec3(value(first), value(first + step), value(first + 2 * step));
    }
  }
}

/// Clamps radiance to the valid range. Returns the number of changed pixels.
std::size_t clamp_pixels(std::vector<Vec3>& pixels) {
  std::size_t changed = 0;
  for (Vec3& pixel : pixels) {
    bool is_good = true;
    for (glm::length_t i = 0; i < 3; ++i) {
      if (pixel[i] >= 0 && pixel[i] <= kMaxRadiance) continue;
      is_good = false;
      pixel[i] = pixel[i] > 0 ? kMaxRadiance : 0;
    }
    changed += is_good ? 0 : 1;
  }
  return changed;
}

}  // namespace

LoadedRadianceMap load_radiance_map(const std::filesystem::path& path, MemoryBudget* memory) {
  const FloatEnvironment environment;
  MemoryAccount work(memory);
  const MemoryScope scope(work);
  const io::DecodedColors decoded =
      io::decode_colors(io::read_regular_file(path, io::kMaxFileSize), path,
                        {.what = "an environment",
                         .hint = "save it again as a plain .exr or .hdr file",
                         .otherwise = "use an environment without a file"});
  const MicrotraceColors& colors = decoded.colors;
  RadianceMap map{.width = colors.whole_width, .height = colors.whole_height};
  MemoryAccount memory_of_map(memory);
  memory_of_map.take(std::uint64_t{map.width} * map.height * sizeof(Vec3),
                     "the pixels of an environment");
  try {
    map.pixels.resize(std::size_t{map.width} * map.height);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::limit, path.string(), "is too large for the available memory");
  }
  if (const auto* floats = std::get_if<std::vector<float>>(&decoded.samples)) {
    fill(
        colors, [&](std::size_t i) { return (*floats)[i]; }, map);
  } else if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&decoded.samples)) {
    const std::vector<float> table = srgb_table<std::uint8_t>();
    fill(
        colors, [&](std::size_t i) { return table[(*bytes)[i]]; }, map);
  } else {
    const auto& words = std::get<std::vector<std::uint16_t>>(decoded.samples);
    const std::vector<float> table = srgb_table<std::uint16_t>();
    fill(
        colors, [&](std::size_t i) { return table[words[i]]; }, map);
  }
  LoadedRadianceMap out;
  const auto warn = [&](std::string&& message) {
    Diagnostic& warning = out.warnings.emplace_back();
    warning.file = path.string();
    warning.message = std::move(message);
  };
  if (const std::size_t changed = clamp_pixels(map.pixels); changed > 0) {
    warn(std::to_string(changed) +
         " pixels of the environment are negative, too bright or not numbers; they are clamped to "
         "0 and 1e9");
  }
  if (map.width != 2 * map.height) {
    warn("an environment is a latitude-longitude map, twice as wide as high; this one of " +
         std::to_string(map.width) + " x " + std::to_string(map.height) + " pixels is stretched");
  }
  const auto counted =
      std::make_shared<CountedMap>(CountedMap{std::move(map), std::move(memory_of_map)});
  out.map = std::shared_ptr<const RadianceMap>(counted, &counted->map);
  return out;
}

}  // namespace microtrace

#include "base/memory_account.hpp"
#include "base/system/float_environment.hpp"
#include "io/file.hpp"
#include "io/image/decode/decode_colors.hpp"
#include "io/image/decode/decode_image.hpp"
#include "io/image/decode/decode_ppm.hpp"

#include <microtrace/compare.hpp>
#include <microtrace/error.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <string_view>
#include <type_traits>

namespace microtrace {
namespace {

/// Converts samples of one to four channels.
template <class Sample>
StoredPicture stored(ImageSize size, std::size_t channels, const std::vector<Sample>& from) {
  constexpr bool is_float = std::is_same_v<Sample, float>;
  StoredPicture picture{
      .size = size,
      .kind = is_float ? StoredPicture::Samples::floats : StoredPicture::Samples::integers,
      .has_alpha = channels == 2 || channels == 4};
  const std::size_t pixels = std::size_t{size.width} * size.height;
  take_memory(pixels * 4 * sizeof(float), "the pixels of a picture");
  picture.samples.resize(pixels * 4);
  const auto value = [&](std::size_t i) {
    if constexpr (is_float)
      return from[i];
    else
      return static_cast<float>(from[i]) / float{std::numeric_limits<Sample>::max()};
  };
  const std::size_t step = channels < 3 ? 0 : 1;
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::size_t first = i * channels;
    for (std::size_t c = 0; c < 3; ++c) picture.samples[4 * i + c] = value(first + step * c);
    picture.samples[4 * i + 3] = picture.has_alpha ? value(first + channels - 1) : 1.0F;
  }
  return picture;
}

StoredPicture stored(const Image& image) {
  return std::visit(
      [&](const auto& samples) {
        return stored({.width = image.width, .height = image.height}, image.channels, samples);
      },
      image.samples);
}

[[noreturn]] void refuse_further_pictures(const std::string& name) {
  throw Error(
      ErrorKind::unsupported, name,
      "contains several pictures, such as frames or pages; store each in a file of its own");
}

/// Multiplies the colors of floats by alpha.
void premultiply(StoredPicture& picture) {
  if (picture.kind != StoredPicture::Samples::floats) return;
  for (std::size_t i = 0; i < picture.samples.size(); i += 4) {
    for (std::size_t c = 0; c < 3; ++c) picture.samples[i + c] *= picture.samples[i + 3];
  }
}

/// Returns true if a WebP file has the flag of animations (WebP container specification).
bool is_animated_webp(std::string_view bytes) {
  constexpr std::size_t kName = 12, kFlags = 20;
  constexpr unsigned kAnimation = 2;
  return bytes.size() > kFlags && bytes.substr(kName, 4) == "VP8X" &&
         (static_cast<unsigned char>(bytes[kFlags]) & kAnimation) != 0;
}

/// Returns true if a PNG file has several frames: a chunk acTL before the first IDAT that says so
/// (PNG 3, section 11.3.6.1).
bool is_animated_png(std::string_view bytes) {
  const auto number = [&](std::size_t place) {
    std::uint64_t value = 0;
    for (const char c : bytes.substr(place, 4)) value = value << 8U | static_cast<unsigned char>(c);
    return value;
  };
  constexpr std::size_t kSignature = 8, kBesideData = 12;  // length, name and checksum of a chunk
  for (std::size_t at = kSignature; bytes.size() - at >= kBesideData;) {
    const std::string_view name = bytes.substr(at + 4, 4);
    if (name == "IDAT") return false;
    if (name == "acTL") return number(at + 8) > 1;
    const std::uint64_t length = number(at);
    at = static_cast<std::size_t>(std::min<std::uint64_t>(at + kBesideData + length, bytes.size()));
  }
  return false;
}

StoredPicture load(const std::filesystem::path& path) {
  const std::string bytes = io::read_file(path, io::kMaxFileSize);
  const std::string name = path.string();
  const std::string_view start(bytes);
  if (io::is_ppm(start)) return stored(io::decode_ppm(bytes, name));
  const bool is_codec = start.starts_with("\x89PNG") || start.starts_with("\xff\xd8\xff") ||
                        (start.starts_with("RIFF") && start.substr(0, 12).ends_with("WEBP"));
  if (!is_codec) {
    const io::DecodedColors decoded =
        io::decode_colors(bytes, path,
                          {.what = "a picture",
                           .hint = "it must be a picture in the format that its extension names",
                           .otherwise = "convert the picture to PNG"});
    if (decoded.colors.has_further != 0) refuse_further_pictures(name);
    StoredPicture picture = std::visit(
        [&](const auto& samples) {
          return stored({.width = decoded.colors.width, .height = decoded.colors.height},
                        decoded.colors.channels, samples);
        },
        decoded.samples);
    if (decoded.colors.is_unassociated != 0) premultiply(picture);
    return picture;
  }
  if (start.starts_with("\x89PNG\r\n\x1a\n") && is_animated_png(start))
    refuse_further_pictures(name);
  if (start.starts_with("RIFF") && is_animated_webp(start)) refuse_further_pictures(name);
  const io::DecodedImage decoded = io::decode_image(bytes);
  if (decoded.no_module) throw Error(ErrorKind::unsupported, name, decoded.complaint);
  if (decoded.too_large)
    throw Error(ErrorKind::limit, name, "has too many pixels, at most 2^28 as memory allows");
  // An incomplete picture has both pixels and a complaint.
  if (!decoded.image || !decoded.complaint.empty())
    throw Error(ErrorKind::io, name, "can't be decoded: " + decoded.complaint);
  return stored(*decoded.image);
}

}  // namespace

StoredPicture load_picture(const std::filesystem::path& path, MemoryBudget* memory) {
  const FloatEnvironment environment;
  MemoryAccount work(memory);
  const MemoryScope scope(work);
  try {
    return load(path);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::limit, path.string(), "is too large for the available memory");
  }
}

}  // namespace microtrace

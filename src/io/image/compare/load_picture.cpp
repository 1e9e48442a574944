#include "base/memory_account.hpp"
#include "base/system/float_environment.hpp"
#include "io/file.hpp"
#include "io/image/decode/decode_colors.hpp"
#include "io/image/decode/decode_image.hpp"
#include "io/image/decode/decode_ppm.hpp"
#include "io/image/decode/image_header.hpp"

#include <microtrace/compare.hpp>
#include <microtrace/error.hpp>

#include <cstddef>
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
  if (io::is_animated(start)) refuse_further_pictures(name);
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

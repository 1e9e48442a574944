#pragma once
/// Compares pictures, for tests of renderings.

#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/film.hpp>
#include <microtrace/memory.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace microtrace {

/// A picture as stored in a file.
struct StoredPicture {
  /// What the numbers of the file are.
  enum class Samples {
    integers,  ///< of 8 or 16 bits: samples as stored, divided by the maximum
    floats,    ///< colors are premultiplied by alpha
  };

  ImageSize size{};
  Samples kind = Samples::integers;
  bool has_alpha = false;
  /// Red, green, blue and alpha of each pixel, row by row from the upper left. Alpha is 1 if the
  /// file has none; gray pictures have three equal colors.
  std::vector<float> samples{};
};

/// Reads the colors and the alpha of a picture: PGM and PPM; PNG, JPEG and WebP by the codec
/// module; EXR by OpenEXR; other formats by OpenImageIO. Other channels are ignored. Throws Error:
/// io if the file can't be read or decoded, limit if it is too large, unsupported if the file has
/// several pictures or if the module is not installed. `memory`, if given, counts the memory for
/// reading.
[[nodiscard]] MICROTRACE_EXPORT StoredPicture load_picture(const std::filesystem::path& path,
                                                           MemoryBudget* memory = nullptr);

/// A position in a picture, counted from the upper left pixel.
struct PixelPosition {
  std::uint32_t x = 0, y = 0;

  bool operator==(const PixelPosition&) const = default;
};

struct PictureDifference {
  std::uint64_t pixels = 0;     ///< number of pixels of each picture
  std::uint64_t differing = 0;  ///< number of pixels with a difference above the threshold
  double maximum = 0;           ///< the greatest absolute difference of two samples
  double mean = 0;              ///< the mean absolute difference of all samples
  double root_mean_square = 0;
  PixelPosition at_maximum{};            ///< the first pixel with the greatest difference
  std::optional<PixelPosition> first{};  ///< the first pixel above the threshold, row by row
  /// The samples of both pictures at `first`, as they were compared.
  std::array<std::array<float, 4>, 2> values{};
};

/// Compares two pictures of the same size, sample by sample. Alpha takes part if one of them has
/// it. Integers are compared as numbers in [0, 1]; n of 255 steps are a difference of exactly
/// n/255. If one picture has integers and the other floats, the floats are first converted to 8
/// bits according to `display`, as save_image() does it. Two infinities of the same sign are equal,
/// and so are two NaN; other differences with NaN are infinite. Throws Error (usage) if the sizes
/// differ.
[[nodiscard]] MICROTRACE_EXPORT PictureDifference compare_pictures(const StoredPicture& a,
                                                                   const StoredPicture& b,
                                                                   double threshold = 0,
                                                                   const Display& display = {});

/// Returns the absolute differences of the colors, of which 8-bit formats show eight
/// times the value. A greater difference of alpha replaces those of the colors.
/// Throws Error (usage) if the sizes differ.
[[nodiscard]] MICROTRACE_EXPORT Film difference_picture(const StoredPicture& a,
                                                        const StoredPicture& b,
                                                        const Display& display = {});

}  // namespace microtrace

#pragma once
/// Rendering of exact quantities (AOVs) alone, into memory of the caller.

#include <microtrace/aov.hpp>
#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/prepared_scene.hpp>
#include <microtrace/render.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

namespace microtrace {

/// Where the values of a quantity are stored. Channel c of the pixel in column x and row y of the
/// picture, or of its crop, is data[y * row_stride + x * pixel_stride + c * channel_stride].
/// Strides count numbers and may be negative.
struct AovBuffer {
  Aov aov = Aov::depth;
  std::variant<float*, std::uint32_t*> data{};  ///< std::uint32_t for Aov::id, float for others
  std::ptrdiff_t row_stride = 0, pixel_stride = 1;
  std::ptrdiff_t channel_stride = 1;
  /// Stores only this channel, as c = 0: 1 for the primitive of Aov::id. Nothing: all channels, as
  /// in channels_of(aov).
  std::optional<std::size_t> channel{};
};

/// Renders the quantities to these buffers, with the bytes of render()'s channels. Each ray is
/// traced once, and no integrator is called. A quantity may be asked for several times; buffers
/// must not overlap. Other memory, such as padding between rows, is not touched.
///
/// Of the options, threads, run_threads, progress, times, counts, memory and crop apply; the others
/// have no effect. Throws Error: usage for a null pointer, the wrong type of numbers, a channel
/// that the quantity doesn't have, or an invalid crop; limit if memory runs out; canceled. After an
/// error, the values in the buffers are undefined.
MICROTRACE_EXPORT void render_aovs(const PreparedScene& scene, const Camera& camera, ImageSize size,
                                   std::span<const AovBuffer> buffers,
                                   const RenderOptions& options = {});

}  // namespace microtrace

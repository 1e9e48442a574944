#pragma once
/// Renders exact quantities (AOVs) without colors into caller-provided buffers.

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

/// The buffer for the values of one quantity. The value of channel c in column x and row y of the
/// picture (or of the crop) is stored in data[y * row_stride + x * pixel_stride + c *
/// channel_stride]. Strides count numbers, not bytes, and may be negative.
struct AovBuffer {
  Aov aov = Aov::depth;
  std::variant<float*, std::uint32_t*> data{};  ///< std::uint32_t* for Aov::id, float* for others
  std::ptrdiff_t row_stride = 0, pixel_stride = 1;
  std::ptrdiff_t channel_stride = 1;
  /// If set, only the channel with this index in channels_of(aov) is stored, as c = 0. For example,
  /// 1 stores the primitives of Aov::id. If not set, all channels are stored.
  std::optional<std::size_t> channel{};
};

/// Renders quantities into buffers. The values equal the channels of render() bit for bit. Each ray
/// is traced once, and no integrator is called. A quantity may have several buffers, but buffers
/// must not overlap. Memory between the values, such as padding between rows, is not touched.
///
/// Only the options threads, run_threads, progress, times, counts, memory and crop have an effect.
/// Throws Error: usage for a null pointer, the wrong type of numbers, a channel that the quantity
/// doesn't have, or an invalid crop; limit if memory runs out; canceled if options.progress returns
/// false. After an error, the values in the buffers are unspecified.
MICROTRACE_EXPORT void render_aovs(const PreparedScene& scene, const Camera& camera, ImageSize size,
                                   std::span<const AovBuffer> buffers,
                                   const RenderOptions& options = {});

}  // namespace microtrace

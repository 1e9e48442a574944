#include "io/image/decode/decode_colors.hpp"

#include "base/memory_account.hpp"
#include "io/file_name.hpp"
#include "io/image/decode/image_header.hpp"
#include "io/image/module.hpp"
#include "io/module_function.hpp"

#include <microtrace/error.hpp>

#include <exception>
#include <new>
#include <optional>
#include <utility>

namespace microtrace::io {
namespace {

constexpr std::uint32_t kMaxSide = 65536;
constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 27U;

/// The samples of a file. Also stores failures, because exceptions must not propagate through the
/// module's frames.
struct ColorDecoding {
  std::optional<MicrotraceColors> colors{};
  std::variant<std::vector<float>, std::vector<std::uint8_t>, std::vector<std::uint16_t>> samples{};
  std::string complaint{};
  bool is_too_large = false;
  std::exception_ptr failure{};
};

void* begin_colors(void* context, const MicrotraceColors* colors) {
  auto& decoded = *static_cast<ColorDecoding*>(context);
  const std::uint64_t pixels = std::uint64_t{colors->width} * colors->height;
  decoded.colors = *colors;
  const auto exceeds = [](std::uint32_t width, std::uint32_t height) {
    return width > kMaxSide || height > kMaxSide || std::uint64_t{width} * height > kMaxPixels;
  };
  decoded.is_too_large =
      exceeds(colors->width, colors->height) || exceeds(colors->whole_width, colors->whole_height);
  if (decoded.is_too_large) return nullptr;
  try {
    const std::size_t count = pixels * colors->channels;
    const std::size_t size = colors->number == kMicrotraceU8    ? 1
                             : colors->number == kMicrotraceU16 ? 2
                                                                : sizeof(float);
    take_memory(count * size, "decoding a picture");
    if (colors->number == kMicrotraceU8)
      return decoded.samples.emplace<std::vector<std::uint8_t>>(count).data();
    if (colors->number == kMicrotraceU16)
      return decoded.samples.emplace<std::vector<std::uint16_t>>(count).data();
    return decoded.samples.emplace<std::vector<float>>(count).data();
  } catch (const std::bad_alloc&) {
    decoded.is_too_large = true;
    return nullptr;
  } catch (const Error&) {
    decoded.failure = std::current_exception();
    return nullptr;
  }
}

void complain_of_colors(void* context, const char* text) {
  try {
    static_cast<ColorDecoding*>(context)->complaint = text;
  } catch (const std::bad_alloc&) {
    static_cast<ColorDecoding*>(context)->is_too_large = true;
  }
}

std::string extension_in(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  return extension.empty() ? extension : extension.substr(1);
}

}  // namespace

DecodedColors decode_colors(const std::string& bytes, const std::filesystem::path& path,
                            const PicturePurpose& purpose) {
  const std::string extension = extension_in(path);
  const FormatModule& module = module_for(extension);
  require_threads(module, path.string());
  const ModuleFunction function = find_module_function(module.file, kDecodeColorsName);
  if (function.address == nullptr) {
    throw Error(ErrorKind::unsupported, path.string(),
                function.complaint + "; install " + module.package + " and build the target " +
                    module.target + ", or " + purpose.otherwise);
  }
  if (is_cut_off_jpeg(bytes)) {
    throw Error(ErrorKind::io, path.string(),
                std::string("can't be decoded: the file ends too early; ") + purpose.hint);
  }
  ColorDecoding decoded;
  const MicrotraceColorSink sink{&decoded, begin_colors, complain_of_colors};
  const auto decode = reinterpret_cast<MicrotraceDecodeColors>(function.address);
  const bool is_decoded = decode(bytes.data(), bytes.size(), extension.c_str(), &sink) != 0;
  if (decoded.failure) std::rethrow_exception(decoded.failure);
  if (decoded.is_too_large) {
    std::string message = std::string("is too large for ") + purpose.what;
    if (decoded.colors) {
      message += ", " + std::to_string(decoded.colors->width) + " x " +
                 std::to_string(decoded.colors->height) + " pixels";
    }
    throw Error(ErrorKind::limit, path.string(),
                message + "; at most 65536 a side and 2^27 together, as memory allows");
  }
  if (!is_decoded) {
    throw Error(ErrorKind::io, path.string(),
                "can't be decoded: " + decoded.complaint + "; " + purpose.hint);
  }
  return {.colors = *decoded.colors, .samples = std::move(decoded.samples)};
}

}  // namespace microtrace::io

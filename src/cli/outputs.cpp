#include "cli/outputs.hpp"

#include <microtrace/error.hpp>

#include <unordered_set>

namespace microtrace::cli {
namespace {

std::string name_of(const std::filesystem::path& path) {
  return path == "-" ? "standard output" : path.string();
}

[[noreturn]] void refuse_same(const Output& a, const Output& b) {
  throw Error(ErrorKind::usage, name_of(b.path),
              std::string("is the file of ") + a.option + " and of " + b.option +
                  "; name another for one of them");
}

}  // namespace

void refuse_to_write_over(const ReadFiles& inputs, const std::vector<Output>& outputs) {
  for (const Output& output : outputs) {
    if (output.path.empty()) continue;
    if (const auto input = inputs.name_of(output.path)) {
      throw Error(ErrorKind::usage, name_of(output.path),
                  "would be written over " + *input +
                      ", from which the picture is made; name "
                      "another file by " +
                      output.option);
    }
  }
}

void refuse_same_files(const std::vector<Output>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Output &a = outputs[k], &b = outputs[i];
      if (!a.path.empty() && !b.path.empty() && are_same_target(a.path, b.path)) refuse_same(a, b);
    }
  }
}

void check_frames(const ReadFiles& inputs, const FrameRange& frames, const std::string& picture,
                  const std::string& sidecar) {
  std::unordered_set<std::string> pictures;
  const auto normal = [](const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal().string();
  };
  for (std::uint32_t frame = frames.first; frame <= frames.last; ++frame) {
    const Output image{"--output", frame_path(picture, frame)};
    const Output beside{"--sidecar", frame_path(sidecar, frame)};
    refuse_to_write_over(inputs, {image, beside});
    if (sidecar.empty()) continue;
    refuse_same_files({image, beside});
    pictures.insert(normal(image.path));
  }
  for (std::uint32_t frame = frames.first; frame <= frames.last && !sidecar.empty(); ++frame) {
    const Output beside{"--sidecar", frame_path(sidecar, frame)};
    if (pictures.contains(normal(beside.path))) refuse_same({"--output", {}}, beside);
  }
}

}  // namespace microtrace::cli

#include "cli/pictures/output_paths.hpp"

#include <microtrace/error.hpp>

#include <unordered_set>

namespace microtrace::cli {
namespace {

std::string name_of(const std::filesystem::path& path) {
  return path == "-" ? "standard output" : path.string();
}

[[noreturn]] void refuse_same(const Output& a, const Output& b) {
  throw Error(ErrorKind::usage, name_of(b.path),
              std::string("is named by both ") + a.option + " and " + b.option +
                  "; choose another file for one of them");
}

}  // namespace

void check_no_input_is_overwritten(const ReadFiles& inputs, const std::vector<Output>& outputs) {
  for (const Output& output : outputs) {
    if (output.path.empty()) continue;
    if (const auto input = inputs.name_of(output.path)) {
      throw Error(ErrorKind::usage, name_of(output.path),
                  "would overwrite " + *input +
                      ", an input of the picture; name another file with " + output.option);
    }
  }
}

void check_outputs_differ(const std::vector<Output>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Output &a = outputs[k], &b = outputs[i];
      if (!a.path.empty() && !b.path.empty() && are_same_target(a.path, b.path)) refuse_same(a, b);
    }
  }
}

void check_paths(const ReadFiles& inputs, const Sequence& sequence) {
  const auto normal = [](const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal().string();
  };
  std::unordered_set<std::string> pictures;
  for (std::uint32_t index = 0; index < sequence.count(); ++index) {
    const Output picture{"--output", sequence.picture(index)};
    const Output sidecar{"--sidecar", sequence.sidecar(index)};
    check_no_input_is_overwritten(inputs, {picture, sidecar});
    check_outputs_differ({picture, sidecar});
    if (!sidecar.path.empty() && sequence.count() > 1) pictures.insert(normal(picture.path));
  }
  // Another frame's sidecar must not overwrite a picture either.
  for (std::uint32_t index = 0; !pictures.empty() && index < sequence.count(); ++index) {
    const Output sidecar{"--sidecar", sequence.sidecar(index)};
    if (pictures.contains(normal(sidecar.path))) refuse_same({"--output", {}}, sidecar);
  }
}

}  // namespace microtrace::cli

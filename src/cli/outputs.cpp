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

void check_inputs_are_kept(const ReadFiles& inputs, const Sequence& sequence) {
  const auto normal = [](const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal().string();
  };
  std::unordered_set<std::string> pictures;
  for (std::uint32_t index = 0; index < sequence.count(); ++index) {
    const Output picture{"--output", sequence.picture(index)};
    const Output sidecar{"--sidecar", sequence.sidecar(index)};
    refuse_to_write_over(inputs, {picture, sidecar});
    refuse_same_files({picture, sidecar});
    if (!sidecar.path.empty() && sequence.count() > 1) pictures.insert(normal(picture.path));
  }
  // A sidecar may also have the name of another frame's picture.
  for (std::uint32_t index = 0; !pictures.empty() && index < sequence.count(); ++index) {
    const Output sidecar{"--sidecar", sequence.sidecar(index)};
    if (pictures.contains(normal(sidecar.path))) refuse_same({"--output", {}}, sidecar);
  }
}

}  // namespace microtrace::cli

#include "cli/pictures/output_paths.hpp"

#include "io/output/output_target.hpp"

#include <microtrace/error.hpp>

#include <cstdint>
#include <string>
#include <unordered_map>

namespace microtrace::cli {
namespace {

std::string name_of(const std::filesystem::path& path) {
  return path == "-" ? "standard output" : path.string();
}

constexpr const char *kCheckpoint = "--checkpoint", *kResume = "--resume";

[[noreturn]] void refuse_same(const Output& a, const Output& b) {
  throw Error(ErrorKind::usage, name_of(b.path),
              std::string("is named by both ") + a.option + " and " + b.option +
                  "; choose another file for one of them");
}

/// The option that names a file, and the index of the picture.
struct Use {
  const char* option;
  std::uint32_t index;
};

/// Throws Error (usage) if the files of two pictures, or two files of one picture, are the same. A
/// checkpoint may be continued.
void check_frames_apart(const Sequence& sequence) {
  std::unordered_map<std::string, Use> uses;
  const auto add = [&](const Use& use, const std::filesystem::path& path) {
    if (path.empty() || path == "-") return;
    const std::filesystem::path target = io::follow_links(std::filesystem::absolute(path));
    const std::string normal = target.lexically_normal().string();
    const auto [at, is_new] = uses.try_emplace(normal, use);
    if (is_new) return;
    const Use& other = at->second;
    const bool is_output = other.option != kResume && other.option != kCheckpoint;
    if (is_output || (other.option == kCheckpoint && other.index != use.index))
      refuse_same({other.option, path}, {use.option, path});
  };
  const auto for_each = [&](const auto& f) {
    for (std::uint32_t index = 0; index < sequence.count(); ++index) f(index);
  };
  for_each([&](auto index) { add({"--output", index}, sequence.picture(index)); });
  for_each([&](auto index) { add({"--sidecar", index}, sequence.sidecar(index)); });
  for_each([&](auto index) { add({kCheckpoint, index}, sequence.checkpoint(index)); });
  for_each([&](auto index) {
    for (const std::filesystem::path& path : sequence.resume(index)) add({kResume, index}, path);
  });
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
  for (std::uint32_t index = 0; index < sequence.count(); ++index) {
    const Output picture{"--output", sequence.picture(index)};
    const Output sidecar{"--sidecar", sequence.sidecar(index)};
    check_no_input_is_overwritten(inputs,
                                  {picture, sidecar, {"--checkpoint", sequence.checkpoint(index)}});
    check_outputs_differ({picture, sidecar});
  }
  if (sequence.count() > 1) check_frames_apart(sequence);
}

}  // namespace microtrace::cli

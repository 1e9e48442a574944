#include "cli/pictures/sequence.hpp"

#include "cli/camera.hpp"

#include <microtrace/framing.hpp>

#include <variant>

namespace microtrace::cli {

std::uint32_t Sequence::count() const {
  return arguments_.frames ? arguments_.frames->count() : 1;
}

std::optional<double> Sequence::time(std::uint32_t index) const {
  if (!arguments_.frames) return arguments_.load.time;
  return arguments_.frames->time(arguments_.frames->first + index);
}

std::filesystem::path Sequence::picture(std::uint32_t index) const {
  return path(arguments_.output, index);
}

std::filesystem::path Sequence::sidecar(std::uint32_t index) const {
  return path(arguments_.sidecar, index);
}

std::filesystem::path Sequence::checkpoint(std::uint32_t index) const {
  return path(arguments_.sampling.checkpoint, index);
}

std::vector<std::filesystem::path> Sequence::resume(std::uint32_t index) const {
  return paths(arguments_.sampling.resume, index);
}

std::vector<std::filesystem::path> Sequence::checkpoints(std::uint32_t index) const {
  return paths(arguments_.checkpoints, index);
}

std::optional<std::uint32_t> Sequence::frame(std::uint32_t index) const {
  if (!arguments_.frames) return std::nullopt;
  return arguments_.frames->first + index;
}

std::vector<std::filesystem::path> Sequence::paths(const std::vector<std::filesystem::path>& names,
                                                   std::uint32_t index) const {
  std::vector<std::filesystem::path> result;
  result.reserve(names.size());
  for (const std::filesystem::path& name : names) result.push_back(path(name, index));
  return result;
}

std::filesystem::path Sequence::path(const std::filesystem::path& name, std::uint32_t index) const {
  return arguments_.frames ? frame_path(name.string(), arguments_.frames->first + index) : name;
}

std::optional<PerspectiveCamera> frame_all(SceneFile& file, const Sequence& sequence,
                                           const Arguments& arguments) {
  if (sequence.count() == 1) return std::nullopt;  // choose_camera() frames a single picture
  const CameraOptions& options = arguments.camera;
  if (options.is_of_scene() && !options.camera.empty()) return std::nullopt;
  LoadedScene posed = file.at(sequence.time(0));
  if (options.is_of_scene() && !posed.scene.cameras.empty()) return std::nullopt;
  Framing framing(options.view(), arguments.size.value_or(posed.scene.size));
  framing.add(posed.scene);
  for (std::uint32_t index = 1; index < sequence.count(); ++index) {
    posed = file.at(sequence.time(index));
    framing.add(posed.scene);
  }
  PerspectiveCamera camera = camera_of(framing, options);
  camera.pose.position += framing.origin();
  return std::get<PerspectiveCamera>(with_lens(camera, options));
}

}  // namespace microtrace::cli

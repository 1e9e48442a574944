#include "cli/pictures/sequence.hpp"

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

}  // namespace microtrace::cli

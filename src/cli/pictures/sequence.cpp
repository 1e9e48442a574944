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

std::filesystem::path Sequence::path(const std::filesystem::path& name, std::uint32_t index) const {
  return arguments_.frames ? frame_path(name.string(), arguments_.frames->first + index) : name;
}

}  // namespace microtrace::cli

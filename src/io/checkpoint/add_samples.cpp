#include <microtrace/checkpoint.hpp>
#include <microtrace/error.hpp>

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace microtrace {
namespace {

/// Splits an identity into its entries: values by option name, sorted by name.
std::map<std::string, std::string, std::less<>> entries_of(std::string_view identity) {
  std::map<std::string, std::string, std::less<>> entries;
  while (!identity.empty()) {
    const std::string_view line = identity.substr(0, identity.find('\n'));
    identity.remove_prefix(std::min(line.size() + 1, identity.size()));
    const std::size_t tab = std::min(line.find('\t'), line.size());
    entries.emplace(line.substr(0, tab), line.substr(std::min(tab + 1, line.size())));
  }
  return entries;
}

/// Returns a message about the first entry that differs, such as "made with --seed 1, not with
/// --seed 2".
std::string difference(std::string_view there, std::string_view here) {
  const auto theirs = entries_of(there), ours = entries_of(here);
  for (const auto& [name, value] : theirs) {
    const auto our = ours.find(name);
    if (our == ours.end()) return "made with " + name + " " + value + ", not without " + name;
    if (our->second != value)
      return "made with " + name + " " + value + ", not with " + name + " " + our->second;
  }
  for (const auto& [name, value] : ours) {
    if (!theirs.contains(name)) return "made without " + name + ", not with " + name + " " + value;
  }
  return "made with the same options in another order";
}

/// Returns true if the picture of both checkpoints is displayed like that of `a`: the one with the
/// first samples, so that the order of merging doesn't matter.
bool decides_display(const Checkpoint& a, const Checkpoint& b) {
  const auto key = [](const Checkpoint& checkpoint) {
    const std::vector<SampleRange>& ranges = checkpoint.sums.ranges();
    const Display& display = checkpoint.display;
    return std::tuple(ranges.empty(), ranges.empty() ? 0 : ranges.front().first, display.exposure,
                      display.tone_map);
  };
  return key(a) < key(b);
}

}  // namespace

void add_samples(Checkpoint& checkpoint, Checkpoint other, const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& message) {
    throw Error(ErrorKind::usage, path.string(), message);
  };
  if (other.identity != checkpoint.identity)
    refuse("holds samples of another picture: " + difference(other.identity, checkpoint.identity));
  if (checkpoint.sums.pixels.empty()) {
    checkpoint.samples = std::max(checkpoint.samples, other.samples);
    checkpoint.display = other.display;
    checkpoint.sums = std::move(other.sums);
    return;
  }
  const SampleSums &theirs = other.sums, &ours = checkpoint.sums;
  if (theirs.window != ours.window || theirs.background != ours.background ||
      other.has_alpha != checkpoint.has_alpha)
    refuse("holds samples of another part or background of the picture");
  for (const SampleRange& range : theirs.ranges()) {
    if (ours.overlaps(range)) {
      refuse("holds samples " + std::to_string(range.first) + " to " +
             std::to_string(range.last - 1) + ", some of which are already present");
    }
  }
  if (decides_display(other, checkpoint)) checkpoint.display = other.display;
  checkpoint.samples = std::max(checkpoint.samples, other.samples);
  checkpoint.sums += theirs;
}

}  // namespace microtrace

#include "base/text/printable.hpp"

#include <microtrace/checkpoint.hpp>
#include <microtrace/error.hpp>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
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

std::string with(const std::string& name, const std::string& value) {
  return "with " + name + (value.empty() ? "" : " " + value);
}

std::string without(const std::string& name) {
  return "without " + name;
}

/// Returns a message about all entries that differ, such as "made with --seed 1, not with --seed 2;
/// with --guiding, not without --guiding".
std::string differences(std::string_view there, std::string_view here) {
  const auto theirs = entries_of(there), ours = entries_of(here);
  std::string message;
  const auto add = [&](const std::string& their, const std::string& our) {
    message.append(message.empty() ? "made " : "; ").append(their).append(", not ").append(our);
  };
  for (const auto& [name, value] : theirs) {
    const auto our = ours.find(name);
    if (our == ours.end())
      add(with(name, value), without(name));
    else if (our->second != value)
      add(with(name, value), with(name, our->second));
  }
  for (const auto& [name, value] : ours) {
    if (!theirs.contains(name)) add(without(name), with(name, value));
  }
  return message.empty() ? "made with the same options in another order" : message;
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

/// Compares the bits of values, because NaN may be among them.
bool are_equal(const Channel& a, const Channel& b) {
  if (is_computed_channel(a.name)) return true;
  const auto bytes = [](const Channel& channel) {
    return std::visit([](const auto& values) { return std::as_bytes(std::span(values)); },
                      channel.values);
  };
  return a.values.index() == b.values.index() && std::ranges::equal(bytes(a), bytes(b));
}

/// Returns true if the picture of the checkpoint has a channel of this name.
bool shows(const Checkpoint& checkpoint, std::string_view name) {
  return std::ranges::find(checkpoint.channels, name, &Channel::name) !=
             checkpoint.channels.end() &&
         !std::ranges::binary_search(checkpoint.only_for_denoising, name);
}

/// Joins the channels of two checkpoints. Channels may depend on the number of requested samples,
/// so those of the checkpoint with fewer are dropped. The order of channels is that of both
/// checkpoints or, if they differ, of their names, so that the order of merging doesn't matter.
/// Returns the name of a channel whose values differ; empty if there is none.
std::string join_channels(Checkpoint& ours, Checkpoint& theirs) {
  if (ours.samples > theirs.samples) return {};
  if (ours.samples < theirs.samples) {
    ours.channels = std::move(theirs.channels);
    ours.only_for_denoising = std::move(theirs.only_for_denoising);
    return {};
  }
  std::vector<std::string> only_for_denoising;
  std::ranges::set_union(ours.only_for_denoising, theirs.only_for_denoising,
                         std::back_inserter(only_for_denoising));
  std::erase_if(only_for_denoising,
                [&](const std::string& name) { return shows(ours, name) || shows(theirs, name); });
  const bool is_same =
      std::ranges::equal(ours.channels, theirs.channels, {}, &Channel::name, &Channel::name);
  for (Channel& channel : theirs.channels) {
    const auto found = std::ranges::find(ours.channels, channel.name, &Channel::name);
    if (found == ours.channels.end()) {
      ours.channels.push_back(std::move(channel));
    } else if (!are_equal(*found, channel)) {
      return channel.name;
    }
  }
  ours.only_for_denoising = std::move(only_for_denoising);
  if (!is_same) std::ranges::sort(ours.channels, {}, &Channel::name);
  return {};
}

}  // namespace

void add_samples(Checkpoint& checkpoint, Checkpoint other, const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& message) {
    throw Error(ErrorKind::usage, path.string(), message);
  };
  if (other.identity != checkpoint.identity) {
    const std::string known =
        checkpoint.file.empty() ? "" : " than " + printable(checkpoint.file.string());
    refuse("holds samples of another picture" + known + ": " +
           differences(other.identity, checkpoint.identity));
  }
  checkpoint.has_lens |= other.has_lens;
  checkpoint.has_ground |= other.has_ground;
  if (checkpoint.sums.pixels.empty()) {
    checkpoint.samples = std::max(checkpoint.samples, other.samples);
    checkpoint.display = other.display;
    checkpoint.sums = std::move(other.sums);
    checkpoint.channels = std::move(other.channels);
    checkpoint.only_for_denoising = std::move(other.only_for_denoising);
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
  if (const std::string name = join_channels(checkpoint, other); !name.empty())
    refuse("holds other values of channel " + name);
  if (decides_display(other, checkpoint)) checkpoint.display = other.display;
  checkpoint.samples = std::max(checkpoint.samples, other.samples);
  checkpoint.sums += theirs;
}

}  // namespace microtrace

#include "cli/options/option.hpp"

#include "base/text/split_at_commas.hpp"

namespace microtrace::cli {
namespace {

/// Returns the rows from the option `first` to the option `last`.
std::span<const Option> rows(std::span<const Option> table, std::string_view first,
                             std::string_view last) {
  const auto begin = std::ranges::find(table, first, &Option::name);
  const auto end = std::ranges::find(table, last, &Option::name);
  return {begin, end + 1};
}

}  // namespace

std::vector<std::string_view> Option::all_names() const {
  return split_at_commas(names);
}

std::string_view Option::name() const {
  const std::vector<std::string_view> all = all_names();
  const auto is_long = [](std::string_view name) { return name.starts_with("--"); };
  const auto found = std::ranges::find_if(all, is_long);
  return found == all.end() ? all.front() : *found;
}

std::vector<OptionGroup> option_groups(Command command) {
  if (command == Command::merge) {
    return {{"Merging", merge_options()},
            {"Display", display_options(command)},
            {"Running", rows(running_options(), "--memory-limit", "--memory-limit")},
            {"Messages and help", common_options()}};
  }
  if (command == Command::dataset) {
    return {{"Data set", dataset_options()},
            {"Pictures", rows(picture_options(), "--size", "--size")},
            {"Pictures", rows(picture_options(), "--background", "--aov")},
            {"Camera of views without one", camera_options()},
            {"Integrator and samples", sampling_options()},
            {"Light", light_options()},
            {"Display", display_options(command)},
            {"glTF assets", rows(asset_options(), "--time", "--fps")},
            {"glTF assets", rows(asset_options(), "--variant", "--allow-path")},
            {"Running", rows(running_options(), "--threads", "--memory-limit")},
            {"Running", rows(running_options(), "--progress", "--strict")},
            {"Messages and help", common_options()}};
  }
  if (command == Command::verify) {
    return {{"Verification", verify_options()},
            {"Running", rows(running_options(), "--threads", "--memory-limit")},
            {"Messages and help", common_options()}};
  }
  if (command == Command::explain) {
    return {{"Explanation", explain_options()},
            {"Camera", rows(picture_options(), "--size", "--size")},
            {"Camera", camera_options()},
            {"glTF assets", rows(asset_options(), "--time", "--animation")},
            {"glTF assets", rows(asset_options(), "--variant", "--allow-path")},
            {"Running", rows(running_options(), "--threads", "--memory-limit")},
            {"Running", rows(running_options(), "--strict", "--strict")},
            {"Messages and help", common_options()}};
  }
  if (command == Command::compare) {
    return {{"Comparison", compare_options()},
            {"Conversion of floats to 8 bits",
             rows(display_options(command), "--exposure", "--tonemap")},
            {"Running", rows(running_options(), "--memory-limit", "--memory-limit")},
            {"Messages and help", rows(common_options(), "--help", "--help")}};
  }
  if (command == Command::view) {
    return {{"Page", view_options()},
            {"Picture", rows(picture_options(), "--size", "--aov")},
            {"Camera", camera_options()},
            {"Integrator and samples", sampling_options()},
            {"Light", light_options()},
            {"Display", rows(display_options(command), "--denoise", "--tonemap")},
            {"glTF assets", rows(asset_options(), "--time", "--animation")},
            {"glTF assets", rows(asset_options(), "--variant", "--allow-path")},
            {"Long renderings", rows(checkpoint_options(), "--quality", "--time-limit")},
            {"Running", rows(running_options(), "--threads", "--memory-limit")},
            {"Messages and help", common_options()}};
  }
  return {{"Picture", picture_options()},
          {"Camera", camera_options()},
          {"Integrator and samples", sampling_options()},
          {"Light", light_options()},
          {"Display", display_options(command)},
          {"glTF assets", asset_options()},
          {"Long renderings", checkpoint_options()},
          {"Running", running_options()},
          {"Messages and help", report_options()},
          {"Messages and help", common_options()}};
}

}  // namespace microtrace::cli

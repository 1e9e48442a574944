#include "cli/options/option.hpp"

namespace microtrace::cli {

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
            {"Display", display_options()},
            {"Messages and help", common_options()}};
  }
  return {{"Picture", picture_options()},
          {"Camera", camera_options()},
          {"Integrator and samples", sampling_options()},
          {"Light", light_options()},
          {"Display", display_options()},
          {"glTF assets", asset_options()},
          {"Long renderings", checkpoint_options()},
          {"Running", running_options()},
          {"Messages and help", report_options()},
          {"Messages and help", common_options()}};
}

}  // namespace microtrace::cli

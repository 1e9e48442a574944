#include "dataset/annotations/npz.hpp"

#include <microtrace/annotations.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace microtrace {
namespace {

/// The values of channels with the same group, interleaved.
template <class Number>
struct Group {
  std::string name;
  std::size_t channels = 0;
  std::vector<Number> values{};
};

std::string group_of(const Channel& channel) {
  return channel.name.substr(0, channel.name.find('.'));
}

template <class Number>
std::vector<Group<Number>> groups_of(const Film& film) {
  std::vector<Group<Number>> groups;
  for (const Channel& channel : film.channels) {
    if (!std::holds_alternative<std::vector<Number>>(channel.values)) continue;
    const std::string name = group_of(channel);
    auto group = std::ranges::find(groups, name, &Group<Number>::name);
    if (group == groups.end()) group = groups.insert(group, {.name = name});
    ++group->channels;
  }
  for (Group<Number>& group : groups) {
    std::size_t c = 0;
    for (const Channel& channel : film.channels) {
      const auto* values = std::get_if<std::vector<Number>>(&channel.values);
      if (values == nullptr || group_of(channel) != group.name) continue;
      group.values.resize(group.channels * values->size());
      for (std::size_t i = 0; i < values->size(); ++i)
        group.values[i * group.channels + c] = (*values)[i];
      ++c;
    }
  }
  return groups;
}

Group<float> colors_of(const Film& film) {
  Group<float> color{.name = "color", .channels = film.has_alpha() ? 4U : 3U};
  for (std::uint32_t y = 0; y < film.size().height; ++y) {
    const auto row = film.row(y);
    for (std::size_t x = 0; x < row.size(); ++x) {
      color.values.insert(color.values.end(), {row[x].x, row[x].y, row[x].z});
      if (film.has_alpha()) color.values.push_back(film.alpha_row(y)[x]);
    }
  }
  return color;
}

}  // namespace

std::string npz_of(const Film& film) {
  const Group<float> color = colors_of(film);
  const auto floats = groups_of<float>(film);
  const auto integers = groups_of<std::uint32_t>(film);
  std::vector<dataset::NpzArray> arrays;
  const auto add = [&]<class Number>(const Group<Number>& group) {
    std::vector<std::size_t> shape{film.size().height, film.size().width};
    if (group.channels > 1) shape.push_back(group.channels);
    arrays.push_back({.name = group.name,
                      .shape = std::move(shape),
                      .values = std::span<const Number>(group.values)});
  };
  add(color);
  for (const auto& group : floats) add(group);
  for (const auto& group : integers) add(group);
  return dataset::npz(arrays);
}

}  // namespace microtrace

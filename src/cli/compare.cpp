#include "cli/compare.hpp"

#include "base/memory_account.hpp"
#include "base/text/printable.hpp"
#include "cli/pictures/exposure.hpp"
#include "cli/report/standard_output.hpp"

#include <microtrace/compare.hpp>
#include <microtrace/error.hpp>
#include <microtrace/io.hpp>
#include <microtrace/read_files.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace microtrace::cli {
namespace {

/// JSON has no infinities, so they are strings, as in explanations of rays.
std::string number(double x, bool is_json) {
  if (!std::isfinite(x)) {
    const std::string name = std::isnan(x) ? "NaN" : x > 0 ? "Infinity" : "-Infinity";
    return is_json ? "\"" + name + "\"" : name;
  }
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), is_json ? "%.17g" : "%.6g", x);
  return text.data();
}

std::string list(const std::array<float, 4>& values, bool is_json) {
  std::string text;
  for (const float value : values) {
    if (!text.empty()) text += is_json ? "," : ", ";
    text += number(static_cast<double>(value), is_json);
  }
  return text;
}

std::string position(const PixelPosition& at) {
  return std::to_string(at.x) + "," + std::to_string(at.y);
}

std::string json_of(const PictureDifference& d) {
  std::string text = "{\"pixels\":" + std::to_string(d.pixels) +
                     ",\"differing\":" + std::to_string(d.differing) +
                     ",\"maximum\":" + number(d.maximum, true) + ",\"at_maximum\":[" +
                     position(d.at_maximum) + "],\"mean\":" + number(d.mean, true) +
                     ",\"root_mean_square\":" + number(d.root_mean_square, true) + ",\"first\":";
  if (!d.first) return text + "null}\n";
  return text + "{\"at\":[" + position(*d.first) + "],\"values\":[[" + list(d.values[0], true) +
         "],[" + list(d.values[1], true) + "]]}}\n";
}

std::string text_of(const PictureDifference& d, double threshold) {
  if (d.maximum == 0) return "equal\n";
  const double percent = 100 * static_cast<double>(d.differing) / static_cast<double>(d.pixels);
  std::string text =
      std::to_string(d.differing) + " of " + std::to_string(d.pixels) + " pixels differ";
  if (threshold > 0) text += " by more than " + number(threshold, false);
  text += " (" + number(percent, false) + " %)\nmaximum           " + number(d.maximum, false) +
          " at " + position(d.at_maximum) + "\nmean              " + number(d.mean, false) +
          "\nroot mean square  " + number(d.root_mean_square, false) + "\n";
  if (!d.first) return text;
  return text + "first             " + position(*d.first) + ": " + list(d.values[0], false) +
         " and " + list(d.values[1], false) + "\n";
}

std::string sizes_text(ImageSize a, ImageSize b, bool is_json) {
  std::array<char, 96> text{};
  (void)std::snprintf(text.data(), text.size(),
                      is_json ? "{\"sizes\":[[%u,%u],[%u,%u]]}\n"
                              : "the sizes differ: %u x %u and %u x %u pixels\n",
                      a.width, a.height, b.width, b.height);
  return text.data();
}

}  // namespace

int compare_files(const Arguments& arguments) {
  const CompareArguments& options = arguments.compare;
  refuse_automatic_exposure(arguments.display, "compare");
  if (options.pictures.size() != 2) refuse_usage("compare needs two pictures");
  const ReadFiles inputs;
  MemoryBudget memory(arguments.memory_limit.value_or(default_memory_limit()));
  if (arguments.output == "-")
    refuse_usage("--output: standard output gets the comparison; name a file");
  if (!arguments.output.empty()) check_image_path(arguments.output);
  MemoryAccount account(&memory);
  const MemoryScope scope(account);
  const auto load = [&](const std::string& name) {
    StoredPicture picture = load_picture(name, &memory);
    account.take(picture.samples.size() * sizeof(float), "the pixels of a picture");
    return picture;
  };
  const StoredPicture a = load(options.pictures[0]), b = load(options.pictures[1]);
  if (const auto name = inputs.name_of(arguments.output); name && !arguments.output.empty())
    refuse_usage("--output: would overwrite " + printable(*name));
  if (a.size.width != b.size.width || a.size.height != b.size.height) {
    write_standard_output(sizes_text(a.size, b.size, options.is_json));
    return kPicturesDiffer;
  }
  Display display;
  display.exposure = arguments.display.exposure.value_or(0);
  display.tone_map = arguments.display.tone_map.value_or(ToneMap::none);
  const PictureDifference difference = compare_pictures(a, b, options.threshold, display);
  const std::string text =
      options.is_json ? json_of(difference) : text_of(difference, options.threshold);
  write_standard_output(text);
  if (!arguments.output.empty()) save_image(difference_picture(a, b, display), arguments.output);
  return difference.differing == 0 ? 0 : kPicturesDiffer;
}

}  // namespace microtrace::cli

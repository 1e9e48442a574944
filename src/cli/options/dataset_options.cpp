#include "base/text/split_at_commas.hpp"
#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <array>

namespace microtrace::cli {
namespace {

constexpr std::array kFormats{Choice<DatasetFormat>{"png", DatasetFormat::png},
                              Choice<DatasetFormat>{"exr", DatasetFormat::exr},
                              Choice<DatasetFormat>{"npz", DatasetFormat::npz},
                              Choice<DatasetFormat>{"coco", DatasetFormat::coco},
                              Choice<DatasetFormat>{"bop", DatasetFormat::bop}};
constexpr std::array kCategories{Choice<CocoCategories>{"objects", CocoCategories::objects},
                                 Choice<CocoCategories>{"materials", CocoCategories::materials}};

std::vector<DatasetFormat> parse_formats(const OptionValue& value) {
  std::vector<DatasetFormat> formats;
  for (const std::string_view name : split_at_commas(value.text)) {
    const DatasetFormat format =
        OptionValue{.option = value.option, .text = std::string(name)}.choice(kFormats);
    if (std::ranges::find(formats, format) == formats.end()) formats.push_back(format);
  }
  return formats;
}

constexpr std::array kDatasetOptions{
    Option{.names = "SCENE",
           .metavar = "FILE",
           .help = "scene file (.json, .gltf, .glb)",
           .samples = Samples::change,
           .completion = Completion::files,
           .is_required = true,
           .set = [](Arguments& a, const OptionValue& value) { a.scene = value.text; }},
    Option{.names = "-o,--output",
           .metavar = "FOLDER",
           .help =
               "folder of the data set; views that are already there and whole are not rendered "
               "again",
           .samples = Samples::keep,
           .completion = Completion::folders,
           .is_required = true,
           .set = [](Arguments& a, const OptionValue& value) { a.output = value.text; }},
    Option{.names = "--views",
           .metavar = "VIEWS",
           .help = "the views: a JSON or .npz file (docs/datasets.md), or views that frame the "
                   "scene from N "
                   "directions: orbit:N or orbit:N,ELEVATION in degrees, hemisphere:N, or random:N "
                   "(by --seed)",
           .default_value = "one view, or the --frames",
           .samples = Samples::change,
           .completion = Completion::files,
           .set = [](Arguments& a, const OptionValue& value) { a.dataset.views = value.text; }},
    Option{.names = "--formats",
           .metavar = "LIST",
           .help =
               "files to write for each view, comma-separated: png (colors), exr or npz (colors "
               "and the channels of --aov), coco (masks and boxes of the visible objects, "
               "joined in coco.json), bop (depth, masks and poses, in the folder bop)",
           .default_value = "png",
           .samples = Samples::change,
           .words = [] { return names_of(kFormats); },
           .takes_list = true,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.dataset.formats = parse_formats(value); }},
    Option{.names = "--name",
           .metavar = "PATTERN",
           .help =
               "names of a view's files without extension: {view} or, with leading zeros, "
               "{view:06d} is the number of the view, {name} its name in the JSON file, {scene} "
               "the name of the scene file",
           .default_value = "{view:06d}",
           .samples = Samples::change,
           .set = [](Arguments& a, const OptionValue& value) { a.dataset.name = value.text; }},
    Option{.names = "--categories",
           .metavar = "KIND",
           .help = "COCO's categories: the names of the objects or of their materials",
           .default_value = "objects",
           .samples = Samples::change,
           .words = [] { return names_of(kCategories); },
           .set =
               [](Arguments& a, const OptionValue& value) {
                 a.dataset.coco.categories = value.choice(kCategories);
               }},
    Option{.names = "--amodal",
           .help = "add masks of hidden parts to coco: the pixels in which an object would be "
                   "visible without the others",
           .samples = Samples::change,
           .set = [](Arguments& a, const OptionValue&) { a.dataset.coco.amodal = true; }},
    Option{
        .names = "--depth-scale",
        .metavar = "MM",
        .help = "millimeters per step of the depth pictures of bop, if a unit of the scene is a "
                "meter",
        .default_value = "0.1",
        .samples = Samples::change,
        .set = [](Arguments& a,
                  const OptionValue& value) { a.dataset.depth_scale = value.positive_number(); }},
    Option{.names = "--shard",
           .metavar = "I/N",
           .help = "render only part I of N of the views; several processes may fill one folder at "
                   "the same time",
           .default_value = "all views",
           .samples = Samples::keep,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.dataset.shard = parse_shard(value); }},
};
static_assert(is_complete(kDatasetOptions));

constexpr std::array kVerifyOptions{
    Option{.names = "FOLDER",
           .metavar = "FOLDER",
           .help = "folder of a data set",
           .samples = Samples::keep,
           .completion = Completion::folders,
           .is_required = true,
           .set = [](Arguments& a, const OptionValue& value) { a.output = value.text; }},
    Option{.names = "--redraw",
           .metavar = "N",
           .help = "render N of the views again, spread evenly, and compare the bytes of their "
                   "files; needs the scene where it was",
           .default_value = "1",
           .samples = Samples::keep,
           .set =
               [](Arguments& a, const OptionValue& value) {
                 a.dataset.redraw = value.whole_number(0, 0xffffffff);
               }},
};
static_assert(is_complete(kVerifyOptions));

}  // namespace

std::span<const Option> dataset_options() {
  return kDatasetOptions;
}

std::span<const Option> verify_options() {
  return kVerifyOptions;
}

}  // namespace microtrace::cli

#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <array>

namespace microtrace::cli {
namespace {

constexpr std::array kPictureOptions{
    Option{.names = "SCENE",
           .metavar = "FILE",
           .help = "scene file (.json, .gltf, .glb), or - for standard input",
           .samples = Samples::keep,
           .completion = Completion::files,
           .is_required = true,
           .set = [](Arguments& a, const OptionValue& value) { a.scene = value.text; }},
    Option{.names = "-o,--output",
           .metavar = "FILE",
           .help =
               "picture file; the extension selects the format (.ppm, .png, .exr, ...); - writes "
               "PPM to standard output",
           .default_value = "the scene's name with .png, in the current folder",
           .samples = Samples::keep,
           .completion = Completion::files,
           .set = [](Arguments& a, const OptionValue& value) { a.output = value.text; }},
    Option{.names = "--size",
           .metavar = "WxH",
           .help = "width and height in pixels",
           .default_value = "the scene's, else 640x480",
           .samples = Samples::change,
           .set = [](Arguments& a, const OptionValue& value) { a.size = parse_size(value); }},
    Option{.names = "--crop",
           .metavar = "x0,y0,x1,y1",
           .help = "render only columns x0 to x1 - 1 and rows y0 to y1 - 1, with the same values "
                   "as in the "
                   "whole picture; 0,0 is the upper left corner",
           .default_value = "the whole picture",
           .samples = Samples::change,
           .set = [](Arguments& a, const OptionValue& value) { a.crop = parse_crop(value); }},
    Option{
        .names = "--background",
        .metavar = "COLOR",
        .help = "color behind all objects: #rrggbb in sRGB, r,g,b in linear light from "
                "0 to 1, env (the environment), or transparent (an alpha channel)",
        .default_value = "0.25,0.25,0.25 for path-traced glTF; otherwise the scene's, else black",
        .samples = Samples::change,
        .words =
            [] {
              return std::vector<std::string>{"env", "transparent"};
            },
        .set =
            [](Arguments& a, const OptionValue& value) {
              a.environment.background = parse_background(value);
            }},
    Option{
        .names = "--aov",
        .metavar = "LIST",
        .help =
            "additional channels of an .exr picture, comma-separated: depth, distance, "
            "position, normal, face_normal, uv, barycentric, albedo and id are exact values at "
            "pixel centers; variance, samples, denoise_albedo, denoise_normal, emission, noisy and "
            "denoise_emission are computed from the samples and need --integrator path",
        .samples = Samples::keep,
        .words = aov_names,
        .takes_list = true,
        .set = [](Arguments& a, const OptionValue& value) { a.aovs = parse_aovs(value); }},
    Option{.names = "--sidecar",
           .metavar = "FILE",
           .help = "JSON file that describes the camera, the objects (ids, names, bounding boxes, "
                   "visible pixels) and the materials",
           .default_value = "the picture's name with .json added if --aov contains id, else none",
           .samples = Samples::keep,
           .completion = Completion::files,
           .set = [](Arguments& a, const OptionValue& value) { a.sidecar = value.text; }},
};
static_assert(is_complete(kPictureOptions));

}  // namespace

std::span<const Option> picture_options() {
  return kPictureOptions;
}

}  // namespace microtrace::cli

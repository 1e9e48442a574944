#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <array>

namespace microtrace::cli {
namespace {

constexpr std::array kExplainOptions{
    Option{.names = "SCENE",
           .metavar = "FILE",
           .help = "scene file (.json, .gltf, .glb), or - for standard input",
           .samples = Samples::keep,
           .completion = Completion::files,
           .is_required = true,
           .set = [](Arguments& a, const OptionValue& value) { a.scene = value.text; }},
    Option{.names = "--pixel",
           .metavar = "x,y",
           .help = "explain the camera ray through the center of the pixel in column x and row y; "
                   "0,0 is the pixel in the upper left corner, and fractions are counted from the "
                   "center",
           .samples = Samples::keep,
           .excludes = "--ray",
           .set = [](Arguments& a,
                     const OptionValue& value) { a.explain.pixel = parse_pixel(value); }},
    Option{.names = "--ray",
           .metavar = "ox,oy,oz,dx,dy,dz",
           .help = "explain the ray from the point o in the direction d, which may have any length "
                   "but 0; two more numbers t_min,t_max limit its interval",
           .samples = Samples::keep,
           .excludes = "--size --camera --view --eye",
           .set = [](Arguments& a, const OptionValue& value) { a.explain.ray = parse_ray(value); }},
    Option{.names = "--json",
           .help = "print JSON instead of text",
           .samples = Samples::keep,
           .set = [](Arguments& a, const OptionValue&) { a.explain.is_json = true; }},
    Option{.names = "--all",
           .help = "explain all hits, even beyond 1000, and all primitives that the ray misses, "
                   "even in scenes of more than 64 primitives",
           .samples = Samples::keep,
           .set = [](Arguments& a, const OptionValue&) { a.explain.is_all = true; }},
};
static_assert(is_complete(kExplainOptions));

}  // namespace

std::span<const Option> explain_options() {
  return kExplainOptions;
}

}  // namespace microtrace::cli

#include "cli/arguments.hpp"
#include "cli/options/option.hpp"

#include <array>

namespace microtrace::cli {
namespace {

double parse_fov(const OptionValue& value) {
  const double degrees = value.number();
  if (!(degrees > 0 && degrees < 180)) value.refuse("degrees between 0 and 180");
  return degrees;
}

/// Greater lengths approach the limits of float32.
constexpr double kGreatestLength = 1e38;

double parse_focus(const OptionValue& value) {
  const double focus = value.number();
  if (!(focus > 0 && focus <= kGreatestLength)) value.refuse("a number above 0, at most 1e38");
  return focus;
}

constexpr std::array kCameraOptions{
    Option{.names = "-c,--camera",
           .metavar = "NAME",
           .help = "camera of the scene, by name or by index from 0",
           .default_value = "the first; --view 30,25 for a scene without cameras",
           .samples = Samples::change,
           .set = [](Arguments& a, const OptionValue& value) { a.camera.camera = value.text; }},
    Option{
        .names = "--view",
        .metavar = "VIEW",
        .help = "frame the whole scene from front (+z), back, left, right (+x), top, bottom or "
                "iso, or from AZIMUTH,ELEVATION in degrees: 0,0 is +z and 90,0 is +x; or place "
                "the camera at AZIMUTH,ELEVATION,DISTANCE from the target",
        .samples = Samples::change,
        .words = view_names,
        .excludes = "--camera",
        .set = [](Arguments& a, const OptionValue& value) { a.camera.orbit = parse_view(value); }},
    Option{.names = "--eye",
           .metavar = "x,y,z",
           .help = "position of a camera that looks at the target",
           .samples = Samples::change,
           .excludes = "--camera --view",
           .set = [](Arguments& a, const OptionValue& value) { a.camera.eye = value.point(); }},
    Option{.names = "--target",
           .metavar = "x,y,z",
           .help = "point that --eye, or --view with a distance, looks at",
           .default_value = "the center of the scene's bounding box",
           .samples = Samples::change,
           .set = [](Arguments& a, const OptionValue& value) { a.camera.target = value.point(); }},
    Option{.names = "--up",
           .metavar = "x,y,z",
           .help = "up direction of the camera at --eye",
           .default_value = "0,1,0",
           .samples = Samples::change,
           .needs = "--eye",
           .set = [](Arguments& a, const OptionValue& value) { a.camera.up = value.point(); }},
    Option{.names = "--fov",
           .metavar = "DEGREES",
           .help = "vertical field of view of the camera defined by --view or --eye",
           .default_value = "45",
           .samples = Samples::change,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.camera.vertical_fov = parse_fov(value); }},
    Option{.names = "--aperture",
           .metavar = "RADIUS",
           .help = "radius of the camera's lens in scene units, for depth of field in path-traced "
                   "pictures; 0 is a pinhole",
           .samples = Samples::change,
           .needs = "--focus",
           .set =
               [](Arguments& a, const OptionValue& value) {
                 a.camera.lens_radius = value.number(0, kGreatestLength);
               }},
    Option{
        .names = "--focus",
        .metavar = "DEPTH",
        .help = "depth along the viewing direction of the points that are sharp if the camera "
                "has a lens",
        .default_value = "the camera's",
        .samples = Samples::change,
        .set = [](Arguments& a, const OptionValue& value) { a.camera.focus = parse_focus(value); }},
};
static_assert(is_complete(kCameraOptions));

}  // namespace

std::span<const Option> camera_options() {
  return kCameraOptions;
}

}  // namespace microtrace::cli

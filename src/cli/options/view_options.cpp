#include "cli/arguments.hpp"
#include "cli/options/option.hpp"
#include "cli/options/values.hpp"

#include <array>

namespace microtrace::cli {
namespace {

constexpr std::array kViewOptions{
    Option{.names = "SCENE",
           .metavar = "FILE",
           .help = "scene file (.json, .gltf, .glb); it is read again when it changes",
           .samples = Samples::change,
           .completion = Completion::files,
           .is_required = true,
           .set = [](Arguments& a, const OptionValue& value) { a.scene = value.text; }},
    Option{.names = "--compare",
           .metavar = "FILE",
           .help = "another scene file, shown beside the first",
           .samples = Samples::keep,
           .completion = Completion::files,
           .set = [](Arguments& a, const OptionValue& value) { a.view.other_scene = value.text; }},
    Option{.names = "--port",
           .metavar = "N",
           .help = "port of 127.0.0.1 at which the page is served",
           .default_value = "any free port",
           .samples = Samples::keep,
           .set =
               [](Arguments& a, const OptionValue& value) {
                 a.view.port = static_cast<std::uint16_t>(value.whole_number(1, 65535));
               }},
    Option{.names = "--no-browser",
           .help = "print the page's address but start no browser",
           .samples = Samples::keep,
           .set = [](Arguments& a, const OptionValue&) { a.view.opens_browser = false; }},
    Option{.names = "--allow-host",
           .metavar = "NAME",
           .help = "accept this host name, or NAME:PORT, in the page's address, for a proxy in "
                   "front of the page",
           .default_value = "localhost and 127.0.0.1 only",
           .samples = Samples::keep,
           .set = [](Arguments& a,
                     const OptionValue& value) { a.view.allowed_host = parse_host(value); }},
};
static_assert(is_complete(kViewOptions));

}  // namespace

std::span<const Option> view_options() {
  return kViewOptions;
}

}  // namespace microtrace::cli

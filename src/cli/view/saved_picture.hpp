#pragma once
#include "cli/view/picture_job.hpp"
#include "io/http/http_server.hpp"

#include <string>

namespace microtrace::cli {

/// Renders a picture and returns the bytes of the file that the program writes with the same
/// options. If the page shows the variance, formats for colors get the picture that it shows. The
/// extension is png, exr or another one without its dot. Throws Error.
[[nodiscard]] io::HttpResponse saved_picture(const PictureJob& job, const std::string& scene,
                                             const std::string& extension);

}  // namespace microtrace::cli

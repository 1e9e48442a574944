#include "cli/view/view.hpp"

#include "base/printable.hpp"
#include "cli/signals.hpp"
#include "cli/view/browser.hpp"
#include "cli/view/view_server.hpp"

#include <microtrace/error.hpp>

#include <cstdio>
#include <string>

namespace microtrace::cli {

void view_scene(const Arguments& arguments) {
  if (arguments.scene == "-")
    refuse_usage("SCENE: standard input can't be read again; name a file");
  ViewServer server(arguments);
  server.load();
  const DelayedSignals delay;  // from the moment at which the address is known
  if (!arguments.quiet) {
    std::fprintf(stderr, "%s is shown at\n", printable(arguments.scene).c_str());
    if (std::printf("%s\n", server.address().c_str()) < 0 || std::fflush(stdout) != 0)
      throw Error(ErrorKind::io, "standard output", "can't be written");
    std::fprintf(stderr, "Press Ctrl-C to end.\n");
  }
  if (arguments.view.opens_browser) open_browser(server.address());
  server.run([] { return DelayedSignals::received() == 0; });
}

}  // namespace microtrace::cli

#include "cli/view/view.hpp"

#include "base/system/start_threads.hpp"
#include "base/text/printable.hpp"
#include "cli/report/standard_output.hpp"
#include "cli/signals.hpp"
#include "cli/view/browser.hpp"
#include "cli/view/view_server.hpp"

#include <microtrace/io.hpp>

#include <chrono>
#include <cstdio>
#include <string>
#include <unistd.h>

namespace microtrace::cli {

void view_scene(const Arguments& arguments) {
  if (arguments.scene == "-")
    refuse_usage("SCENE: standard input can't be read again; name a file");
  if (arguments.view.other_scene == "-")
    refuse_usage("--compare: standard input can't be read again; name a file");
  if (!can_start_threads(2)) {
    throw Error(ErrorKind::limit, "view",
                "needs threads, which the system refuses to start; raise the limit on processes "
                "(ulimit -u)");
  }
  ViewServer server(arguments);
  server.load();
  const DelayedSignals delay;  // from the moment at which the address is known
  if (!arguments.quiet) {
    std::fprintf(stderr, "%s is shown at\n", printable(arguments.scene).c_str());
    write_standard_output(server.address() + "\n");
    std::fprintf(stderr, "Press Ctrl-C to end.\n");
  }
  if (arguments.view.opens_browser) open_browser(server.address());
  server.run([] { return DelayedSignals::received() == 0; });
  constexpr std::chrono::milliseconds kTimeToStop{500};
  if (server.stop(kTimeToStop)) return;
  // Loading a scene can't be canceled, so the process ends without waiting for its threads.
  remove_unfinished_files();
  _exit(0);
}

}  // namespace microtrace::cli

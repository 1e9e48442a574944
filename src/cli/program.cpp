#include "cli/program.hpp"

#include "base/system/float_environment.hpp"
#include "base/system/free_memory.hpp"
#include "base/system/start_threads.hpp"
#include "base/text/printable.hpp"
#include "cli/arguments.hpp"
#include "cli/compare.hpp"
#include "cli/dataset/dataset.hpp"
#include "cli/explain.hpp"
#include "cli/merge.hpp"
#include "cli/options/completion.hpp"
#include "cli/options/help.hpp"
#include "cli/options/parse.hpp"
#include "cli/options/usage_error.hpp"
#include "cli/pictures/render_pictures.hpp"
#include "cli/report/progress_bar.hpp"
#include "cli/report/standard_output.hpp"
#include "cli/signals.hpp"
#include "cli/view/view.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <fcntl.h>
#include <new>
#include <string>
#include <string_view>
#include <sys/resource.h>
#include <unistd.h>

namespace microtrace {
namespace {

void print_error(const char* message) {
  cli::clear_progress_bar();
  std::fprintf(stderr, "error: %s\n", message);
}

/// Runs a command and returns its exit code. Prints its error, if any.
template <class Work>
int exit_code_of(const Work& work) {
  try {
    return work();
  } catch (const cli::Interruption& interruption) {
    return 128 + interruption.signal;
  } catch (const Error& error) {
    print_error(error.what());
    return static_cast<int>(error.kind());
  } catch (const std::bad_alloc&) {
    print_error(out_of_memory());
    return static_cast<int>(ErrorKind::limit);
  } catch (const std::exception& error) {
    print_error(printable(error.what()).c_str());
    return static_cast<int>(ErrorKind::internal);
  }
}

bool traces_rays(cli::Command command, const cli::Arguments& arguments) {
  if (command == cli::Command::verify) return arguments.dataset.redraw > 0;
  return command != cli::Command::merge && command != cli::Command::compare;
}

/// Writes to the part of the stack that rays need. If the address space is limited (ulimit -v), the
/// stack could no longer grow after scenes have taken the rest.
[[gnu::noinline]] void reach_stack() {
  std::array<char, kStackSize / 2> part;
  volatile char* const begin = part.data();
  for (std::size_t at = 0; at < part.size(); at += 4096) begin[at] = 0;
}

/// Throws Error (limit) if rays may overflow the stack of the main thread.
void require_stack() {
  rlimit stack{};
  if (::getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur >= kStackSize) return reach_stack();
  const rlim_t better = std::min(8 * kStackSize, stack.rlim_max);  // which needs no privilege
  throw Error(ErrorKind::limit, "",
              "stacks are limited to " + std::to_string(stack.rlim_cur >> 10U) +
                  " KiB, but microtrace needs 1024 KiB; " +
                  (better < kStackSize
                       ? "the hard limit must be raised, which needs privileges"
                       : "raise the limit, as by ulimit -s " + std::to_string(better >> 10U)));
}

/// Opens those of the descriptors 0 to 2 that are closed, for the opposite of their use, so that
/// they still can't be used. Otherwise, the next opened file would get that number, and receive the
/// output.
void reserve_standard_descriptors() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(number, F_GETFD) < 0)
      static_cast<void>(::open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

/// Applies the options that end a run early.
void limit_run(const cli::Arguments& arguments) {
  if (arguments.parent) cli::end_with_parent(*arguments.parent);
  if (arguments.max_time) cli::end_after(*arguments.max_time);
}

/// A command, which the user selects by its name as the first argument.
struct NamedCommand {
  cli::Command command;
  int (*run)(const cli::Arguments&);  ///< returns the exit code
};

/// Calls a command that succeeds unless it throws.
template <void (*command)(const cli::Arguments&)>
int succeed(const cli::Arguments& arguments) {
  command(arguments);
  return 0;
}

constexpr std::array kNamedCommands{
    NamedCommand{cli::Command::merge, succeed<cli::merge_samples>},
    NamedCommand{cli::Command::dataset, succeed<cli::write_dataset>},
    NamedCommand{cli::Command::verify, succeed<cli::verify_dataset>},
    NamedCommand{cli::Command::explain, succeed<cli::explain_ray>},
    NamedCommand{cli::Command::compare, cli::compare_files},
    NamedCommand{cli::Command::view, succeed<cli::view_scene>},
};

/// Parses the arguments of the command and runs it. Returns the exit code.
int run_command(const NamedCommand& named, int argc, char** argv) {
  const cli::Parsed parsed = cli::parse_arguments(named.command, argc, argv);
  if (parsed.exit_code) return *parsed.exit_code;
  return exit_code_of([&] {
    if (parsed.output) {
      cli::write_standard_output(*parsed.output);
      return 0;
    }
    if (traces_rays(named.command, parsed.arguments)) require_stack();
    limit_run(parsed.arguments);
    return named.run(parsed.arguments);
  });
}

}  // namespace

int cli::run_program(int argc, char** argv) {
  const FloatEnvironment environment;
  reserve_standard_descriptors();
  cli::handle_signals();
  if (cli::is_completion(argc, argv)) {
    return exit_code_of([&] {
      cli::write_standard_output(cli::completion_text(argc, argv));
      return 0;
    });
  }
  for (const NamedCommand& named : kNamedCommands) {
    if (argc > 1 && argv[1] == cli::name_of(named.command))
      return run_command(named, argc - 1, argv + 1);
  }
  if (argc > 1) {
    if (const auto complaint = cli::complaint_about_command(argv[1]))
      return cli::report_usage_error(cli::Command::render, *complaint);
  }
  return run_command({cli::Command::render, cli::render_pictures}, argc, argv);
}

}  // namespace microtrace

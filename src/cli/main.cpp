#include "cli/program.hpp"

int main(int argc, char** argv) {
  return microtrace::cli::run_program(argc, argv);
}

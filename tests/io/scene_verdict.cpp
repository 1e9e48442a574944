// Prints `accept PATH` or `reject PATH` for each scene file on the command line.

#include <microtrace/io.hpp>

#include <iostream>

int main(int count, char** arguments) {
  for (int i = 1; i < count; ++i) {
    try {
      (void)microtrace::load_scene(arguments[i]);
      std::cout << "accept " << arguments[i] << '\n';
    } catch (const microtrace::Error&) {
      std::cout << "reject " << arguments[i] << '\n';
    }
  }
}

// Computes the headers with tables of src/render/bsdf.
//
// make_tables FOLDER           writes all headers
// make_tables FOLDER HEADER    computes one header, and fails unless the folder has an equal one

#include "tables/tables.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace {

using microtrace::tables::Header;
using microtrace::tables::kHeaders;

std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool is_same(const Header& header, const std::filesystem::path& path) {
  const std::string wanted = header.text(), text = file_text(path);
  if (text == wanted) return true;
  std::size_t line = 1, i = 0;
  for (; i < text.size() && i < wanted.size() && text[i] == wanted[i]; ++i) line += text[i] == '\n';
  std::fprintf(stderr, "%s:%zu: is not what make_tables writes\n", path.c_str(), line);
  return false;
}

int run(const std::filesystem::path& folder, const std::string& name) {
  for (const Header& header : kHeaders) {
    if (name.empty()) {
      std::ofstream file(folder / header.name, std::ios::binary);
      if (!(file << header.text() << std::flush))
        throw std::runtime_error((folder / header.name).string() + ": can't be written");
    } else if (name == header.name) {
      return is_same(header, folder / header.name) ? 0 : 1;
    }
  }
  if (name.empty()) return 0;
  throw std::runtime_error(name + ": there is no such header");
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 2 || count > 3) return 2;
  return run(arguments[1], count == 3 ? arguments[2] : "");
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}

/// Binds the parts of the command `microtrace dataset`, for microtrace.distributed.

#include "base/system/float_environment.hpp"
#include "cli/dataset/dataset.hpp"
#include "cli/options/parse.hpp"
#include "common.hpp"

#include <filesystem>
#include <memory>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace microtrace::python {
namespace {

namespace fs = std::filesystem;

/// A data set and the warnings about it. Only one thread may use it at a time.
class Dataset {
 public:
  /// If `root` is not empty, files are looked for below it first, by their absolute names. Names in
  /// the list of views are relative to `folder`. `threads` are used if the words don't state a
  /// number.
  Dataset(std::vector<std::string> words, const fs::path& folder, const fs::path& root,
          unsigned threads)
      : dataset_(arguments_of(std::move(words), threads), &warnings_, [&](const std::string& name) {
          const fs::path copy = root / (folder / name).lexically_normal().relative_path();
          std::error_code error;
          return !root.empty() && fs::exists(copy, error) ? copy.string() : name;
        }) {}

  cli::Dataset& dataset() { return dataset_; }

  nb::list take_warnings() { return to_python(std::exchange(warnings_, {})); }

 private:
  static cli::Arguments arguments_of(std::vector<std::string> words, unsigned threads) {
    cli::Arguments arguments = cli::parse_words(cli::Command::dataset, std::move(words));
    if (arguments.threads == 0) arguments.threads = threads;
    return arguments;
  }

  std::vector<Diagnostic> warnings_;
  cli::Dataset dataset_;
};

/// Reads the files of a data set. Returns the names of all files that were read.
nb::tuple read(std::vector<std::string> words) {
  std::vector<std::string> names;
  std::unique_ptr<Dataset> dataset;
  run_unlocked([&] {
    const FloatEnvironment environment;
    const ReadFiles files;
    dataset = std::make_unique<Dataset>(std::move(words), fs::path(), fs::path(), 0);
    dataset->dataset().read_all();
    for (const auto& [name, state] : files.states()) {
      if (state != FileState{}) names.push_back(name);
    }
  });
  return nb::make_tuple(std::move(dataset), names);
}

/// Makes the data set without the interpreter's lock.
void open(Dataset* self, std::vector<std::string> words, const fs::path& folder,
          const fs::path& root, unsigned threads) {
  run_unlocked([&] {
    const FloatEnvironment environment;
    new (self) Dataset(std::move(words), folder, root, threads);
  });
}

std::vector<std::string> render(Dataset& self, const fs::path& path, std::uint32_t view) {
  return result_unlocked([&] {
    const FloatEnvironment environment;
    DatasetFolder folder(path);
    return self.dataset().render(folder, view);
  });
}

std::vector<std::string> finish(Dataset& self, const fs::path& path) {
  return result_unlocked([&] {
    const FloatEnvironment environment;
    return self.dataset().finish(DatasetFolder(path));
  });
}

bool is_whole(const fs::path& path, std::uint32_t view) {
  return result_unlocked([&] { return DatasetFolder(path).is_whole(view); });
}

}  // namespace

void bind_datasets(nb::module_& module) {
  nb::class_<Dataset>(module, "Dataset")
      .def("__init__", &open, WholeCall())
      .def(
          "order", [](Dataset& self) { return self.dataset().order(); }, WholeCall())
      .def(
          "content",
          [](Dataset& self) {
            const DatasetIdentity& identity = self.dataset().identity();
            return nb::make_tuple(identity.program, identity.digest);
          },
          WholeCall())
      .def(
          "create",
          [](Dataset& self, const fs::path& path) {
            const DatasetFolder created = self.dataset().create(path);
          },
          WholeCall())
      .def("render", &render, WholeCall())
      .def("finish", &finish, WholeCall())
      .def("take_warnings", &Dataset::take_warnings, WholeCall());
  module.def("read_dataset", &read, WholeCall());
  module.def("is_whole_view", &is_whole, WholeCall());
}

}  // namespace microtrace::python

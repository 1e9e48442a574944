#include "base/counted.hpp"
#include "base/text/printable.hpp"
#include "cli/dataset/dataset.hpp"
#include "cli/dataset/plan.hpp"
#include "cli/dataset/view_renderer.hpp"
#include "cli/options/parse.hpp"
#include "cli/temporary_folder.hpp"

#include <microtrace/dataset.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <system_error>
#include <vector>

namespace microtrace::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const DatasetFolder& folder, const std::string& file, const char* reason) {
  throw Error(ErrorKind::io, (folder.path() / file).string(), reason);
}

/// The arguments with which the data set was started.
Arguments arguments_of(const DatasetIdentity& identity) {
  std::vector<std::string> words{"--output=."};
  words.insert(words.end(), identity.arguments.begin(), identity.arguments.end());
  try {
    return parse_words(Command::dataset, std::move(words));
  } catch (const Error& error) {
    throw Error(ErrorKind::usage, "dataset.json",
                std::string("has invalid arguments: ") + error.what());
  }
}

/// Renders views again and compares their files with those of the data set.
void redraw(const DatasetFolder& folder, const std::vector<std::uint32_t>& indices,
            const Arguments& given) {
  Arguments arguments = arguments_of(folder.identity());
  arguments.threads = given.threads;
  arguments.memory_limit = given.memory_limit;
  arguments.quiet = true;
  const std::vector<DatasetView> views = views_of(arguments);
  if (views.size() != folder.identity().views)
    fail(folder, "dataset.json", "was changed: its arguments give another number of views");
  Warnings warnings(arguments);
  ViewRenderer renderer(arguments, warnings);
  const TemporaryFolder copy;
  for (const std::uint32_t index : indices) {
    renderer.render(views.at(index), index, copy.path());
    if (const auto name = first_damaged(copy.path(), *folder.files(index)))
      fail(folder, *name, "differs from the view that is rendered now");
  }
}

}  // namespace

void verify_dataset(const Arguments& arguments) {
  const DatasetFolder folder(fs::absolute(arguments.output));
  const std::uint32_t count = folder.identity().views;
  std::vector<std::uint32_t> finished;
  for (std::uint32_t view = 0; view < count; ++view) {
    const auto known = folder.files(view);
    if (!known) continue;
    if (const auto name = first_damaged(folder.path(), *known))
      fail(folder, *name, "is missing or was changed since it was rendered");
    finished.push_back(view);
  }
  const std::size_t wanted = std::min<std::size_t>(arguments.dataset.redraw, finished.size());
  std::vector<std::uint32_t> sample;
  for (std::size_t i = 0; i < wanted; ++i) sample.push_back(finished[i * finished.size() / wanted]);
  if (!sample.empty()) {
    // Paths in the arguments are relative to the folder in which the data set was started.
    std::error_code error;
    fs::current_path(folder.identity().folder, error);
    redraw(folder, sample, arguments);
  }
  if (finished.size() < count) {
    throw Error(ErrorKind::io, arguments.output.string(),
                "lacks " + std::to_string(count - finished.size()) + " of " +
                    counted(count, "view") + "; continue with microtrace dataset");
  }
  const std::uint64_t files = folder.check_manifest();
  if (arguments.quiet) return;
  std::fprintf(stderr, "%s: %s, %s, all whole; %s rendered again: the same\n",
               printable(arguments.output.string()).c_str(), counted(count, "view").c_str(),
               counted(files, "file").c_str(), counted(sample.size(), "view").c_str());
}

}  // namespace microtrace::cli

/// Binds the page of `microtrace view`.

#include "base/system/start_threads.hpp"
#include "cli/options/parse.hpp"
#include "cli/view/view_server.hpp"
#include "common.hpp"
#include "prepared.hpp"

#include <atomic>
#include <memory>
#include <nanobind/stl/vector.h>
#include <string>
#include <utility>
#include <vector>

namespace microtrace::python {
namespace {

/// Shows a prepared scene as if it came from a file. A scene that has a background is treated like
/// a JSON scene, because the background of glTF assets is a default of the program.
std::shared_ptr<const cli::ShownScene> shown(const Prepared& prepared) {
  const bool is_json = prepared.is_flat || prepared.has_background;
  return std::make_shared<const cli::ShownScene>(cli::with_extent(
      {.prepared = prepared.scene, .format = is_json ? SceneFormat::json : SceneFormat::gltf}));
}

cli::Arguments arguments_of(const Prepared& prepared, std::string name,
                            std::vector<std::string> words, std::uint16_t port,
                            const std::string& allowed_host) {
  if (!prepared.is_flat && prepared.has_background) {
    for (const char* word : {"path", "--integrator"}) words.insert(words.begin(), word);
  }
  words.insert(words.begin(), "scene");  // a name may look like an option
  if (!allowed_host.empty()) words.push_back("--allow-host=" + allowed_host);
  cli::Arguments arguments = cli::parse_words(cli::Command::view, std::move(words));
  arguments.scene = std::move(name);
  if (port != 0) arguments.view.port = port;
  return arguments;
}

/// Serves on a thread of its own until it is closed.
class Viewer {
 public:
  Viewer(const Prepared& prepared, const cli::Arguments& arguments)
      : server_(std::make_unique<cli::ViewServer>(arguments, shown(prepared))),
        address_(server_->address()),
        port_(server_->port()) {
    server_->load();
    thread_ = start_threads(1, [this] { serve(); });
    if (thread_.empty())
      throw Error(ErrorKind::limit, "", "the system refuses to start a thread for the page");
  }
  ~Viewer() { close(); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  void close() {
    is_closed_ = true;
    thread_.clear();
    server_.reset();
  }
  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] unsigned port() const { return port_; }
  [[nodiscard]] bool is_closed() const { return is_closed_; }

 private:
  void serve() {
    try {
      server_->run([this] { return !is_closed_; });
    } catch (const std::exception&) {
      // The page then reports that the server doesn't answer.
    }
    is_closed_ = true;  // a button of the page ends it too
  }

  std::unique_ptr<cli::ViewServer> server_;  ///< null if it is closed
  std::string address_;
  unsigned port_;
  std::atomic<bool> is_closed_ = false;
  std::vector<Thread> thread_;
};

void open_viewer(Viewer* self, const Prepared& prepared, std::string name,
                 std::vector<std::string> words, std::uint16_t port,
                 const std::string& allowed_host) {
  const cli::Arguments arguments =
      arguments_of(prepared, std::move(name), std::move(words), port, allowed_host);
  run_unlocked([&] { new (self) Viewer(prepared, arguments); });
}

}  // namespace

void bind_viewer(nb::module_& module) {
  nb::class_<Viewer>(module, "Viewer")
      .def("__init__", &open_viewer, nb::arg("prepared"), nb::arg("name"), nb::arg("words"),
           nb::arg("port"), nb::arg("allowed_host"), WholeCall())
      .def("close", [](Viewer& self) { run_unlocked([&] { self.close(); }); })
      .def_prop_ro("address", &Viewer::address)
      .def_prop_ro("port", &Viewer::port)
      .def_prop_ro("is_closed", &Viewer::is_closed);
}

}  // namespace microtrace::python

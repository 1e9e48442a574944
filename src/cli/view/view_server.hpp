#pragma once
/// Answers the requests of the page. docs/internals.md lists them.

#include "cli/arguments.hpp"
#include "cli/view/errands.hpp"
#include "cli/view/file_watch.hpp"
#include "cli/view/live_picture.hpp"
#include "cli/view/query.hpp"
#include "cli/view/scene_source.hpp"
#include "io/http/http_server.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace microtrace::cli {

class ViewServer {
 public:
  /// Shows the scene file of the arguments, or `scene` if it is given. Throws Error: unsupported if
  /// the module is missing, io if the port can't be used.
  explicit ViewServer(const Arguments& arguments,
                      std::shared_ptr<const ShownScene> scene = nullptr);
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;
  ~ViewServer();

  /// Loads the scene with the program's options, so that the first page shows it sooner. Throws
  /// Error.
  void load();

  /// The address of the page. It contains the token that all requests need.
  [[nodiscard]] std::string address() const;
  /// The port of 127.0.0.1, and the path of the page.
  [[nodiscard]] std::uint16_t port() const { return http_.port(); }
  [[nodiscard]] const std::string& token() const { return token_; }

  /// Answers requests until goes_on(), which is called ten times a second, returns false, or until
  /// the page requests the end. Throws Error.
  void run(const std::function<bool()>& goes_on);

  /// Ends all drawing and all other work, and waits for it for this time. Returns true if it has
  /// ended, so that the destructor doesn't wait.
  [[nodiscard]] bool stop(std::chrono::milliseconds time);

 private:
  /// The number of pictures that are drawn for open pages. The one that was not asked for the
  /// longest time makes room for another one. As many may still be stopping.
  static constexpr std::size_t kMostPictures = 8;

  void handle(const io::HttpRequest& request, const io::HttpReply& reply);
  void answer(const io::HttpRequest& request, const io::HttpReply& reply);
  void answer_picture(const io::HttpRequest& request, const std::string& id,
                      const io::HttpReply& reply);
  void open_picture(const io::HttpRequest& request, const io::HttpReply& reply);
  /// Closes a picture without waiting for its thread.
  void close_picture(std::map<std::string, std::unique_ptr<LivePicture>>::iterator picture);
  void forget_stopped();
  /// Returns the scene that the parameter `scene` selects. Throws Error (usage).
  [[nodiscard]] SceneSource& source_of(const Query& query);
  /// Returns the words of the program's command line. A number replaces an automatic exposure, so
  /// that the exposure stays the same while the view turns.
  [[nodiscard]] std::vector<std::string> first_words(SceneSource& source) const;
  void describe_scene(const io::HttpRequest& request, const io::HttpReply& reply);
  void save_picture(const io::HttpRequest& request, const io::HttpReply& reply);
  /// Calls work() on another thread and replies with its result, or with its error.
  void run_errand(const io::HttpReply& reply, std::function<io::HttpResponse()> work);
  void tick();

  Arguments arguments_;
  MemoryBudget memory_;                                ///< of all scenes
  std::vector<std::unique_ptr<SceneSource>> sources_;  ///< by number of the scene
  std::string token_;
  std::atomic<bool> is_ending_ = false;
  std::vector<FileWatch> watches_;  ///< of the files of each source
  unsigned ticks_ = 0;
  // Errands and pictures keep replies, which refer to the server.
  io::HttpServer http_;
  std::map<std::string, std::unique_ptr<LivePicture>> pictures_;
  std::list<std::unique_ptr<LivePicture>> stopping_;
  std::uint64_t opened_pictures_ = 0;
  Errands errands_;
};

}  // namespace microtrace::cli

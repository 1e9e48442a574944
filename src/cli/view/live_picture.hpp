#pragma once
/// A picture on the page, which refines while the user looks at it and changes with the options.

#include "base/system/start_threads.hpp"
#include "cli/arguments.hpp"
#include "cli/view/picture_job.hpp"
#include "cli/view/scene_source.hpp"
#include "io/http/http_server.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace microtrace::cli {

/// Renders on a thread of its own while somebody asks for the picture.
class LivePicture {
 public:
  /// The source must outlive this object. Throws Error (limit) if the system refuses the thread.
  explicit LivePicture(SceneSource& source);
  ~LivePicture();
  LivePicture(const LivePicture&) = delete;
  LivePicture& operator=(const LivePicture&) = delete;

  /// Ends the drawing soon, without waiting: a scene that is being loaded is loaded completely.
  void stop();
  /// Returns true after stop() if the destructor doesn't wait.
  [[nodiscard]] bool has_stopped() const { return has_stopped_; }

  /// Draws another picture. While the camera is moving, one sample per pixel is drawn, at a lower
  /// resolution if this would take too long. Returns the number of the request.
  std::uint64_t request(Arguments arguments, bool is_moving);

  /// Replies with the first picture, or error, whose sequence number is above `after`; now or when
  /// there is one. A later call replaces one that is still waiting, which gets the status 204.
  void poll(std::uint64_t after, const io::HttpReply& reply);

  /// Must be called several times per second: gives waiting calls of poll() the status 204 after 10
  /// s, and draws the picture again if the scene file has changed.
  void tick();

  /// Replies to a call of poll() that is waiting, if there is one.
  void answer_poll(const io::HttpResponse& response);

  /// The time since the last call of poll().
  [[nodiscard]] std::chrono::duration<double> idle_time() const;

 private:
  using Clock = std::chrono::steady_clock;

  struct Request {
    std::uint64_t number = 0;  ///< 0: none
    Arguments arguments{};
    bool is_moving = false;
  };
  struct Waiting {
    io::HttpReply reply;
    std::uint64_t after;
    Clock::time_point since;
  };
  /// What a published picture shows.
  struct Status {
    std::uint32_t samples = 0;
    bool is_preview = false, is_done = false;
  };

  void work();
  void draw(const Request& request);
  /// Draws one sample per pixel at a resolution that takes about 60 ms.
  void draw_preview(const PictureJob& job, const Request& request);
  void draw_samples(PictureJob& job, const Request& request);
  [[nodiscard]] std::uint32_t preview_divisor(ImageSize size) const;
  [[nodiscard]] bool is_due() const;
  /// Returns true if the picture of the request is no longer needed.
  [[nodiscard]] bool is_outdated(const Request& request) const;
  [[nodiscard]] bool is_awaited() const;
  void publish(const Film& film, const PictureJob& job, const Request& request, Status status);
  void publish_error(const std::string& error, const Request& request);
  void publish(io::HttpResponse response);

  SceneSource& source_;
  double sample_time_ = 1e-6;  ///< seconds per sample of the last preview
  Clock::time_point start_;    ///< of the current request's drawing

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  bool is_stopping_ = false;
  Request wanted_;
  std::uint64_t drawn_ = 0, drawn_revision_ = 0, drawing_revision_ = 0;
  std::uint64_t sequence_ = 0;
  std::optional<io::HttpResponse> latest_;
  std::optional<Waiting> waiting_;
  Clock::time_point last_poll_ = Clock::now();

  std::atomic<bool> has_stopped_ = false;
  std::vector<Thread> thread_;
};

}  // namespace microtrace::cli

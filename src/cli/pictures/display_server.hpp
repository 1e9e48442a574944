#pragma once
/// Shows pictures in the image viewer tev (https://github.com/Tom94/tev) while they are rendered,
/// by its protocol over TCP.

#include "cli/options/values.hpp"

#include <microtrace/film.hpp>

#include <chrono>
#include <string>

namespace microtrace::cli {

class DisplayServer {
 public:
  /// Connects. Throws Error (io) on failure. If the viewer ends or stops receiving later, warns
  /// unless `is_quiet` and shows nothing more.
  DisplayServer(const NetworkAddress& address, bool is_quiet);
  DisplayServer(const DisplayServer&) = delete;
  DisplayServer& operator=(const DisplayServer&) = delete;
  ~DisplayServer();

  /// Shows the film's colors, as EXR files store them, in the picture with this name. Opens the
  /// picture if the previous call had another name.
  void show(const std::string& name, const Film& film);
  /// Returns true if showing pictures takes less than a twentieth of the time.
  [[nodiscard]] bool is_due() const;

 private:
  using Clock = std::chrono::steady_clock;

  void open(const Film& film);
  void send(std::string packet);

  int socket_ = -1;  ///< -1 after an error
  bool is_quiet_;
  std::string name_{};
  Clock::time_point shown_{};
  Clock::duration cost_{0};
};

}  // namespace microtrace::cli

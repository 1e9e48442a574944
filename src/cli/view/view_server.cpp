#include "cli/view/view_server.hpp"

#include "base/system/free_memory.hpp"
#include "base/text/printable.hpp"
#include "cli/options/option_value.hpp"
#include "cli/view/page.hpp"
#include "cli/view/picture_job.hpp"
#include "cli/view/picture_json.hpp"
#include "cli/view/saved_picture.hpp"

#include <microtrace/error.hpp>
#include <microtrace/explain.hpp>

#include <algorithm>
#include <new>
#include <sys/random.h>
#include <thread>
#include <utility>

namespace microtrace::cli {
namespace {

/// Returns 128 random bits as 32 hexadecimal digits.
std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw Error(ErrorKind::internal, "", "the system has no random numbers for the page's token");
  std::string token;
  for (const unsigned char byte : bytes) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    token += kDigits[byte >> 4];
    token += kDigits[byte & 15];
  }
  return token;
}

io::HttpResponse json_response(std::string body, unsigned status = 200) {
  return {.status = status, .type = "application/json", .body = std::move(body)};
}

io::HttpResponse busy() {
  return json_response(error_json("the server is busy; try again when it has answered"), 503);
}

io::HttpResponse closed() {
  return json_response(error_json("this picture was closed"), 410);
}

unsigned status_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
    case ErrorKind::invalid_scene:
    case ErrorKind::unsupported:
      return 422;
    case ErrorKind::canceled:
      return 503;
    default:
      return 500;
  }
}

/// Returns the result of work(), or a response that describes its error.
template <class Work>
io::HttpResponse response_of(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    return json_response(error_json(error.what()), status_of(error.kind()));
  } catch (const std::bad_alloc&) {
    return json_response(error_json(out_of_memory()), 500);
  } catch (const std::exception& error) {
    return json_response(error_json(printable(error.what())), 500);
  }
}

}  // namespace

ViewServer::ViewServer(const Arguments& arguments, std::shared_ptr<const ShownScene> scene)
    : arguments_(arguments),
      memory_(arguments.memory_limit.value_or(default_memory_limit())),
      token_(random_token()),
      http_({.port = arguments.view.port,
             .token = token_,
             .allowed_host = arguments.view.allowed_host},
            [this](const io::HttpRequest& request, const io::HttpReply& reply) {
              handle(request, reply);
            }) {
  sources_.push_back(std::make_unique<SceneSource>(arguments, memory_, std::move(scene)));
  if (!arguments.view.other_scene.empty()) {
    Arguments other = arguments;
    other.scene = arguments.view.other_scene;
    sources_.push_back(std::make_unique<SceneSource>(other, memory_));
  }
  for (const auto& source : sources_) watches_.emplace_back().watch(source->files());
}

ViewServer::~ViewServer() {
  is_ending_ = true;
}

void ViewServer::load() {
  for (const auto& source : sources_) static_cast<void>(make_job(*source, arguments_));
}

std::string ViewServer::address() const {
  return "http://127.0.0.1:" + std::to_string(port()) + "/" + token_ + "/";
}

void ViewServer::run(const std::function<bool()>& goes_on) {
  http_.run([&] {
    tick();
    return goes_on() && !is_ending_;
  });
  is_ending_ = true;
}

void ViewServer::tick() {
  for (const auto& [id, picture] : pictures_) picture->tick();
  forget_stopped();
  constexpr unsigned kWatchEvery = 2;
  if (++ticks_ % kWatchEvery != 0) return;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    watches_[i].watch(sources_[i]->files());
    if (watches_[i].has_changed()) sources_[i]->discard();
  }
}

void ViewServer::handle(const io::HttpRequest& request, const io::HttpReply& reply) {
  const io::HttpResponse failure = response_of([&] {
    answer(request, reply);
    return io::HttpResponse{};
  });
  if (failure.status != 200) reply(failure);
}

void ViewServer::answer(const io::HttpRequest& request, const io::HttpReply& reply) {
  const std::string& path = request.path;
  const bool reads = request.method == "GET" || request.method == "HEAD";
  const bool posts = request.method == "POST";
  const auto files = page_files();
  const auto file = std::ranges::find(files, path, &PageFile::path);
  const std::string_view pictures = "pictures/";
  if (file != files.end() && reads)
    return reply({.type = std::string(file->type), .body = std::string(file->content)});
  if (path == "scene" && posts) return describe_scene(request, reply);
  if (path == "pictures" && posts) return open_picture(request, reply);
  if (path.starts_with(pictures))
    return answer_picture(request, path.substr(pictures.size()), reply);
  if (path == "explanation" && posts) {
    return run_errand(reply, [this, request] {
      const Query query(request.query);
      const PictureJob job = make_job(source_of(query), parse_picture(arguments_, request.body));
      return json_response(explanation_json(explain(job.scene->prepared, job.camera, job.size,
                                                    query.number("x"), query.number("y"))));
    });
  }
  if (path == "file" && posts) return save_picture(request, reply);
  if (path == "end" && posts) {
    is_ending_ = true;
    return reply({.body = "The server ends.\n"});
  }
  const bool is_known = file != files.end() || path == "scene" || path == "pictures" ||
                        path == "explanation" || path == "file" || path == "end";
  reply(json_response(
      error_json(is_known ? "this address does not accept " + printable(request.method)
                          : "there is nothing at this address"),
      is_known ? 405 : 404));
}

void ViewServer::answer_picture(const io::HttpRequest& request, const std::string& id,
                                const io::HttpReply& reply) {
  const auto found = pictures_.find(id);
  if (found == pictures_.end()) return reply(closed());
  LivePicture& picture = *found->second;
  const Query query(request.query);
  if (request.method == "GET") return picture.poll(query.whole_number("after"), reply);
  if (request.method == "PUT") {
    const std::uint64_t number =
        picture.request(parse_picture(arguments_, request.body), query.has("moving"));
    return reply(json_response("{\"request\":" + std::to_string(number) + "}"));
  }
  if (request.method == "DELETE") {
    picture.answer_poll(closed());
    close_picture(found);
    return reply({.status = 204});
  }
  reply(json_response(error_json("use GET, PUT or DELETE"), 405));
}

void ViewServer::open_picture(const io::HttpRequest& request, const io::HttpReply& reply) {
  SceneSource& source = source_of(Query(request.query));
  forget_stopped();
  if (stopping_.size() >= kMostPictures) return reply(busy());
  if (pictures_.size() >= kMostPictures) {
    const auto oldest = std::ranges::max_element(
        pictures_, {}, [](const auto& entry) { return entry.second->idle_time().count(); });
    oldest->second->answer_poll(closed());
    close_picture(oldest);
  }
  const std::string id = std::to_string(++opened_pictures_);
  pictures_.emplace(id, std::make_unique<LivePicture>(source));
  reply(json_response("{\"id\":\"" + id + "\"}"));
}

void ViewServer::close_picture(
    std::map<std::string, std::unique_ptr<LivePicture>>::iterator picture) {
  picture->second->stop();
  stopping_.push_back(std::move(picture->second));
  pictures_.erase(picture);
}

void ViewServer::forget_stopped() {
  stopping_.remove_if([](const auto& picture) { return picture->has_stopped(); });
}

bool ViewServer::stop(std::chrono::milliseconds time) {
  is_ending_ = true;
  while (!pictures_.empty()) close_picture(pictures_.begin());
  const auto end = std::chrono::steady_clock::now() + time;
  for (;;) {
    forget_stopped();
    if (stopping_.empty() && errands_.are_done()) return true;
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

std::vector<std::string> ViewServer::first_words(SceneSource& source) const {
  std::vector<std::string> words = arguments_.view.words;
  if (arguments_.display.exposure) return words;
  std::string lines;
  for (const std::string& word : words) lines.append(word).append("\n");
  try {
    const PictureJob job = make_job(source, parse_picture(arguments_, lines));
    if (!job.arguments.display.exposure) return words;
    const auto given = std::ranges::find(words, "--exposure");
    if (given != words.end()) words.erase(given, given + 2);
    words.insert(words.end(), {"--exposure", shortest(*job.arguments.display.exposure)});
  } catch (const Error&) {
    return words;  // the page shows the error when it asks for the picture
  }
  return words;
}

void ViewServer::describe_scene(const io::HttpRequest& request, const io::HttpReply& reply) {
  run_errand(reply, [this, request] {
    SceneSource& source = source_of(Query(request.query));
    SceneDescription description{.name = source.name(),
                                 .words = arguments_.view.words,
                                 .revision = source.revision(),
                                 .scenes = sources_.size()};
    try {
      const auto scene = source.get(parse_picture(arguments_, request.body).load);
      description.words = first_words(source);
      return json_response(scene_json(description, *scene));
    } catch (const Error& error) {
      // The page starts with the program's options and waits until the file is repaired.
      return json_response(scene_json(description, error.what()), status_of(error.kind()));
    }
  });
}

void ViewServer::save_picture(const io::HttpRequest& request, const io::HttpReply& reply) {
  run_errand(reply, [this, request, reply] {
    const Query query(request.query);
    SceneSource& source = source_of(query);
    PictureJob job = make_job(source, parse_picture(arguments_, request.body));
    job.options.progress = [this, &reply](double) { return !is_ending_ && reply.is_awaited(); };
    return saved_picture(job, source.name(), query.text("format"));
  });
}

SceneSource& ViewServer::source_of(const Query& query) {
  const std::uint64_t number = query.has("scene") ? query.whole_number("scene") : 0;
  if (number >= sources_.size()) refuse_usage("scene: there is no scene with this number");
  return *sources_[number];
}

void ViewServer::run_errand(const io::HttpReply& reply, std::function<io::HttpResponse()> work) {
  const bool is_running =
      errands_.run([reply, work = std::move(work)] { reply(response_of(work)); });
  if (!is_running) reply(busy());
}

}  // namespace microtrace::cli

#include "cli/view/live_picture.hpp"

#include "base/system/float_environment.hpp"
#include "base/system/free_memory.hpp"
#include "base/system/start_threads.hpp"
#include "base/text/printable.hpp"
#include "cli/view/picture_json.hpp"
#include "io/image/encode/png.hpp"

#include <microtrace/error.hpp>
#include <microtrace/sample_sums.hpp>

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

namespace microtrace::cli {
namespace {

constexpr std::chrono::seconds kLongestWait{10}, kLongestIdleTime{30};
constexpr double kPreviewTime = 0.06;  // seconds

/// Drawing the pictures between the first and the last takes at most this fraction of the time.
constexpr double kPublishingShare = 0.2;

std::string png_of(const Film& film) {
  std::string file;
  io::PngEncoder("the picture", io::PngEncoder::Speed::fast)
      .encode(film, [&](std::string_view part) { file += part; });
  return file;
}

}  // namespace

LivePicture::LivePicture(SceneSource& source) : source_(source) {
  thread_ = start_threads(1, [this] {
    work();
    has_stopped_ = true;
  });
  if (thread_.empty())
    throw Error(ErrorKind::limit, "", "the system refuses to start a thread for another picture");
}

LivePicture::~LivePicture() {
  stop();
  thread_.clear();
}

void LivePicture::stop() {
  std::optional<Waiting> waiting;
  const std::scoped_lock lock(mutex_);
  is_stopping_ = true;
  waiting = std::exchange(waiting_, std::nullopt);
  changed_.notify_all();
}

std::uint64_t LivePicture::request(Arguments arguments, bool is_moving) {
  const std::scoped_lock lock(mutex_);
  wanted_ = {
      .number = wanted_.number + 1, .arguments = std::move(arguments), .is_moving = is_moving};
  last_poll_ = Clock::now();
  changed_.notify_all();
  return wanted_.number;
}

void LivePicture::poll(std::uint64_t after, const io::HttpReply& reply) {
  std::optional<Waiting> former;
  std::optional<io::HttpResponse> response;
  {
    const std::scoped_lock lock(mutex_);
    last_poll_ = Clock::now();
    changed_.notify_all();  // drawing continues after a time without calls
    former = std::exchange(waiting_, std::nullopt);
    if (latest_ && sequence_ > after)
      response = latest_;
    else
      waiting_ = Waiting{.reply = reply, .after = after, .since = last_poll_};
  }
  if (former) former->reply({.status = 204});
  if (response) reply(*response);
}

void LivePicture::tick() {
  std::optional<Waiting> expired;
  {
    const std::scoped_lock lock(mutex_);
    if (waiting_ && Clock::now() - waiting_->since > kLongestWait)
      expired = std::exchange(waiting_, std::nullopt);
    changed_.notify_all();
  }
  if (expired) expired->reply({.status = 204});
}

void LivePicture::answer_poll(const io::HttpResponse& response) {
  std::optional<Waiting> waiting;
  {
    const std::scoped_lock lock(mutex_);
    waiting = std::exchange(waiting_, std::nullopt);
  }
  if (waiting) waiting->reply(response);
}

std::chrono::duration<double> LivePicture::idle_time() const {
  const std::scoped_lock lock(mutex_);
  return waiting_ ? std::chrono::duration<double>(0) : Clock::now() - last_poll_;
}

bool LivePicture::is_due() const {
  if (wanted_.number == 0) return false;
  const bool is_idle = !waiting_ && Clock::now() - last_poll_ > kLongestIdleTime;
  return !is_idle && (drawn_ != wanted_.number || drawn_revision_ != source_.revision());
}

bool LivePicture::is_outdated(const Request& request) const {
  const std::scoped_lock lock(mutex_);
  if (is_stopping_ || source_.revision() != drawing_revision_) return true;
  // Pictures of a moving camera are finished; otherwise none would appear during fast movements.
  if (wanted_.number != request.number && !request.is_moving) return true;
  return !waiting_ && Clock::now() - last_poll_ > kLongestIdleTime;
}

bool LivePicture::is_awaited() const {
  const std::scoped_lock lock(mutex_);
  return waiting_.has_value();
}

void LivePicture::work() {
  const FloatEnvironment environment;
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return is_stopping_ || is_due(); });
    if (is_stopping_) return;
    const Request request = wanted_;
    drawing_revision_ = source_.revision();
    lock.unlock();
    bool is_drawn = true;
    try {
      draw(request);
    } catch (const Error& error) {
      is_drawn = error.kind() != ErrorKind::canceled;
      if (is_drawn) publish_error(error.what(), request);
    } catch (const std::bad_alloc&) {
      publish_error(out_of_memory(), request);
    } catch (const std::exception& error) {
      publish_error(printable(error.what()), request);
    }
    lock.lock();
    if (!is_drawn) continue;
    drawn_ = request.number;
    drawn_revision_ = drawing_revision_;
  }
}

void LivePicture::draw(const Request& request) {
  start_ = Clock::now();
  PictureJob job = make_job(source_, request.arguments);
  job.options.progress = [&](double) { return !is_outdated(request); };
  const bool needs_preview = preview_divisor(job.size) > 1 && !job.options.crop;
  if (request.is_moving) {
    job.options.passes.reset();
    job.options.samples = 1;
  }
  if (request.is_moving || needs_preview) draw_preview(job, request);
  if (!request.is_moving) draw_samples(job, request);
}

std::uint32_t LivePicture::preview_divisor(ImageSize size) const {
  const double pixels = static_cast<double>(size.width) * size.height;
  for (const std::uint32_t divisor : {1U, 2U, 4U, 8U}) {
    if (pixels / (divisor * divisor) * sample_time_ <= kPreviewTime) return divisor;
  }
  return 16;
}

void LivePicture::draw_preview(const PictureJob& job, const Request& request) {
  const std::uint32_t divisor = job.options.crop ? 1 : preview_divisor(job.size);
  const auto part = [divisor](std::uint32_t length) { return (length + divisor - 1) / divisor; };
  const ImageSize size{.width = part(job.size.width), .height = part(job.size.height)};
  RenderOptions options = job.options;
  options.passes.reset();
  options.samples = 1;
  options.aovs.clear();
  options.sampled_aovs.clear();
  const auto start = Clock::now();
  Film film = microtrace::render(job.scene->prepared, job.camera, size, options);
  const std::chrono::duration<double> time = Clock::now() - start;
  const ImageSize drawn = film.size();
  sample_time_ = time.count() / (static_cast<double>(drawn.width) * drawn.height);
  film.display = job.options.integrator->is_data() ? film.display : job.display;
  publish(film, job, request, {.samples = 1, .is_preview = true});
}

void LivePicture::draw_samples(PictureJob& job, const Request& request) {
  const Film::Alpha alpha =
      job.options.transparent ? Film::Alpha::premultiplied : Film::Alpha::none;
  Clock::time_point published = Clock::now();
  Clock::duration cost{0};
  std::uint32_t taken = job.options.samples;  // --time-limit may end the picture earlier
  if (job.integrator->is_random()) {
    if (!job.options.passes) job.options.passes.emplace();
    job.options.passes->after_each = [&](const SampleSums& sums) {
      taken = sums.count();
      if (sums.count() == job.options.samples || !is_awaited()) return;
      const Clock::time_point start = Clock::now();
      if ((start - published) * kPublishingShare < cost) return;
      Film film = develop(sums, alpha);
      film.display = job.display;
      if (shows_variance(job)) {
        film.channels = {{.name = "variance.Y", .values = std::vector<float>(sums.pixels.size())}};
        compute_channels(sums, film.channels);
        film = deviation_picture(film);
      }
      publish(film, job, request, {.samples = sums.count()});
      published = Clock::now();
      cost = published - start;
    };
  }
  Film film = render(job);
  if (shows_variance(job)) film = deviation_picture(film);
  publish(film, job, request, {.samples = taken, .is_done = true});
}

void LivePicture::publish(const Film& film, const PictureJob& job, const Request& request,
                          Status status) {
  const std::chrono::duration<double> time = Clock::now() - start_;
  PictureDescription description{.request = request.number,
                                 .revision = drawing_revision_,
                                 .samples = status.samples,
                                 .requested_samples = job.options.samples,
                                 .is_preview = status.is_preview,
                                 .is_done = status.is_done,
                                 .seconds = time.count()};
  publish({.type = "image/png", .body = png_of(film), .picture = json_of(description, job)});
}

void LivePicture::publish_error(const std::string& error, const Request& request) {
  publish({.type = "application/json",
           .body = error_json(error),
           .picture = json_of(PictureDescription{
               .request = request.number, .revision = drawing_revision_, .is_done = true})});
}

void LivePicture::publish(io::HttpResponse response) {
  std::optional<Waiting> waiting;
  {
    const std::scoped_lock lock(mutex_);
    ++sequence_;
    response.picture = with_sequence(response.picture, sequence_);
    latest_ = response;
    if (waiting_ && waiting_->after < sequence_) waiting = std::exchange(waiting_, std::nullopt);
  }
  if (waiting) waiting->reply(response);
}

}  // namespace microtrace::cli

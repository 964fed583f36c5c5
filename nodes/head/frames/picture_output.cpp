#include "nodes/head/frames/picture_output.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/log/log.hpp"
#include "nodes/frame_spans/span_scope.hpp"
#include "nodes/head/statistics/output_spans.hpp"

namespace mural {
namespace {

constexpr size_t kQueuedPictures = 3;
constexpr std::chrono::milliseconds kSlice{500};

template <class... Parts> void warn(const Parts&... parts) { log::warning(log::Topic::Output, parts...); }

} // namespace

PictureOutput::PictureOutput(PictureOutputConfig config, std::unique_ptr<PictureSink> file)
    : config_(std::move(config)),
      saveFrames_(config_.saveFrames.begin(), config_.saveFrames.end()),
      file_(std::move(file)),
      fileOverlay_(config_.overlayInFiles ? config_.overlay : nullptr),
      canvases_(config_.canvases.size()),
      natives_({config_.pairs, config_.openWindow, config_.giveToProgram, config_.done, config_.displayBlocked,
                config_.statistics, config_.overlay, config_.beginOverlay, config_.endOverlay}),
      thread_([this] { work(); }) {}

PictureOutput::~PictureOutput() {
    drop();
    thread_.join();
}

void PictureOutput::drop() {
    natives_.drop();
    const std::lock_guard lock(mutex_);
    dropped_ = true;
    changed_.notify_all();
}

void PictureOutput::add(WindowPicture picture) {
    const std::lock_guard lock(mutex_);
    queue_.push_back(std::move(picture));
    changed_.notify_all();
}

void PictureOutput::windowGone(uint32_t client, uint32_t window) {
    WindowPicture last;
    last.client = client;
    last.window = window;
    add(std::move(last));
}

void PictureOutput::closeWall() { add({}); }

void PictureOutput::clientGone(uint32_t client) {
    WindowPicture last;
    last.client = client;
    add(std::move(last));
}

void PictureOutput::waitForRoom() {
    const SpanScope waits(SpanKind::WaitOutput);
    std::unique_lock lock(mutex_);
    while (queue_.size() > kQueuedPictures && !dropped_ && !ended_) changed_.wait_for(lock, kSlice);
}

bool PictureOutput::finish(Deadline deadline) {
    std::unique_lock lock(mutex_);
    finishing_ = true;
    changed_.notify_all();
    while (!ended_ && !deadline.passed()) changed_.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs(kNsPerS)));
    return ended_;
}

OutputTotals PictureOutput::totals() const {
    const std::lock_guard lock(mutex_);
    return totals_;
}

void PictureOutput::work() {
    std::unique_lock lock(mutex_);
    while (!dropped_ && !(finishing_ && queue_.empty())) {
        if (queue_.empty()) {
            changed_.wait_for(lock, kSlice);
            continue;
        }
        const WindowPicture picture = std::move(queue_.front());
        queue_.pop_front();
        changed_.notify_all();
        lock.unlock();
        take(picture);
        lock.lock();
    }
    queue_.clear();
    lock.unlock();
    natives_.finish();
    wall_.reset();
    if (file_) finishFile();
    canvases_.clear();
    for (const OtherCanvas& canvas : config_.canvases) {
        if (!canvas.file) continue;
        if (const auto finished = canvas.file->finish(); !finished) warn(finished.error().message);
    }
    lock.lock();
    ended_ = true;
    changed_.notify_all();
}

// An incomplete video has no readable frame, so it counts no saved pictures.
void PictureOutput::finishFile() {
    const auto finished = file_->finish();
    if (finished) return;
    warn(finished.error().message);
    const std::lock_guard lock(mutex_);
    totals_.savedPictures = 0;
}

void PictureOutput::take(const WindowPicture& picture) {
    if (!picture.picture && picture.client == 0) return wall_.reset();
    if (!picture.picture) return forget(picture);
    recordOutput(config_.statistics, spans_, picture.client, picture.frame, "output", [&] { show(picture); });
}

void PictureOutput::show(const WindowPicture& picture) {
    const Picture view = picture.picture->view();
    const int64_t wallFrame = mainWindow_.swapped(picture.client, picture.window, static_cast<uint32_t>(view.width),
                                                  static_cast<uint32_t>(view.height), picture.nativeWindow);
    const bool inTime = config_.lastFrame == 0 || wallFrame <= config_.lastFrame;
    const bool wanted = wallFrame > 0 && inTime && (saveFrames_.empty() || saveFrames_.contains(wallFrame));
    if (wallFrame > 0 && config_.offerToPages) config_.offerToPages(wallFrame, picture.picture);
    if (wanted && file_ && !fileFailed_) save(wallFrame, view);
    if (wallFrame > 0 && config_.openWall && picture.isOnWall) showOnWall(wallFrame, view);
    for (size_t i = 0; wallFrame > 0 && i < std::min(canvases_.size(), picture.others.size()); ++i)
        if (picture.others[i]) showOnCanvas(i, wallFrame, picture.others[i]->view(), wanted);
    if (wallFrame > 0) {
        const std::lock_guard lock(mutex_);
        totals_.wallFrames = wallFrame;
    }
    if (config_.toNativeWindows && picture.nativeWindow != 0)
        natives_.show(picture);
    else
        config_.done(picture.client, picture.frame);
}

// Shows the picture. Rounds to 8 bits per channel for a sink without deep pictures.
Result<void> PictureOutput::give(PictureSink& sink, int64_t frame, const Picture& picture, bool pair) {
    Picture shown = picture;
    if (shown.format != PictureFormat::Bgra8 && !sink.takesDeepPictures()) {
        eightBits_.resize(shown.width, shown.height);
        copyInto(eightBits_, 0, 0, shown);
        shown = eightBits_.view();
    }
    return pair ? sink.showPair(frame, eyesOfStack(shown)) : sink.show(frame, shown);
}

void PictureOutput::save(int64_t frame, const Picture& picture) {
    if (picture.format != PictureFormat::Bgra8 && !std::exchange(eightBitsReported_, true))
        warn("the program's window has 10 bits per channel; --out saves 8 of them");
    OverlayPlace place = config_.overlayInFiles.value_or(OverlayPlace{});
    place.title = "file";
    place.wallWidth = picture.width;
    place.wallHeight = picture.height;
    const auto saved = give(*file_, frame, fileOverlay_.over(picture, std::move(place)), config_.pairs);
    if (!saved) {
        warn(saved.error().message, "; no further pictures are saved");
        fileFailed_ = true;
        return;
    }
    const std::lock_guard lock(mutex_);
    ++totals_.savedPictures;
    totals_.lastSavedFrame = frame;
}

void PictureOutput::showOnWall(int64_t frame, const Picture& picture) {
    if (wallFailed_) return;
    if (!wall_) {
        auto opened = config_.openWall();
        if (opened)
            wall_ = std::move(*opened);
        else
            warn(opened.error().message);
    }
    const auto shown = wall_ ? give(*wall_, frame, picture, config_.pairs) : Result<void>();
    if (!shown) warn(shown.error().message, "; the wall windows show no further pictures");
    wallFailed_ = !wall_ || !shown;
}

void PictureOutput::showOnCanvas(size_t index, int64_t frame, const Picture& picture, bool saves) {
    const OtherCanvas& canvas = config_.canvases[index];
    Shown& shown = canvases_[index];
    if (canvas.file && saves && !shown.fileFailed) {
        if (const auto saved = give(*canvas.file, frame, picture, canvas.pairs); !saved) {
            warn("canvas ", canvas.name, ": ", saved.error().message, "; no further pictures of it are saved");
            shown.fileFailed = true;
        }
    }
    if (!canvas.openWall || shown.wallFailed) return;
    if (!shown.wall) {
        auto opened = canvas.openWall();
        if (opened)
            shown.wall = std::move(*opened);
        else
            warn("canvas ", canvas.name, ": ", opened.error().message);
    }
    const auto done = shown.wall ? give(*shown.wall, frame, picture, canvas.pairs) : Result<void>();
    if (!done) warn("canvas ", canvas.name, ": ", done.error().message, "; its windows show no further pictures");
    shown.wallFailed = !shown.wall || !done;
}

void PictureOutput::forget(const WindowPicture& gone) {
    if (gone.window != 0) {
        mainWindow_.windowGone(gone.client, gone.window);
        natives_.windowGone(gone.client, gone.window);
        return;
    }
    mainWindow_.clientGone(gone.client);
    natives_.clientGone(gone.client);
}

} // namespace mural

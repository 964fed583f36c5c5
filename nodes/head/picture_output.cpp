#include "nodes/head/picture_output.hpp"

#include <algorithm>
#include <chrono>

namespace mural {
namespace {

constexpr size_t kQueuedPictures = 3;
constexpr size_t kMostWindows = 64;
constexpr std::chrono::milliseconds kSlice{500};

} // namespace

PictureOutput::PictureOutput(PictureOutputConfig config, std::unique_ptr<PictureSink> file)
    : config_(std::move(config))
    , saveFrames_(config_.saveFrames.begin(), config_.saveFrames.end())
    , file_(std::move(file))
    , thread_([this] { work(); }) {}

PictureOutput::~PictureOutput() {
    drop();
    thread_.join();
}

void PictureOutput::drop() {
    const std::lock_guard lock(mutex_);
    dropped_ = true;
    changed_.notify_all();
}

void PictureOutput::add(WindowPicture picture) {
    const std::lock_guard lock(mutex_);
    queue_.push_back(std::move(picture));
    changed_.notify_all();
}

void PictureOutput::clientGone(uint32_t client) {
    WindowPicture last;
    last.client = client;
    add(std::move(last));
}

void PictureOutput::waitForRoom() {
    std::unique_lock lock(mutex_);
    while (queue_.size() > kQueuedPictures && !dropped_ && !ended_) changed_.wait_for(lock, kSlice);
}

bool PictureOutput::finish(Deadline deadline) {
    std::unique_lock lock(mutex_);
    finishing_ = true;
    changed_.notify_all();
    while (!ended_ && !deadline.passed())
        changed_.wait_for(lock, std::chrono::nanoseconds(deadline.leftNs(kNsPerS)));
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
        if (picture.picture) show(picture);
        else forget(picture.client);
        lock.lock();
    }
    queue_.clear();
    lock.unlock();
    windows_.clear();
    if (file_) {
        if (const auto finished = file_->finish(); !finished) config_.say(finished.error().message);
    }
    lock.lock();
    ended_ = true;
    changed_.notify_all();
}

void PictureOutput::show(const WindowPicture& picture) {
    const Picture view = picture.picture->view();
    const int64_t mainFrame =
        mainWindow_.swapped(picture.client, picture.window, static_cast<uint32_t>(view.width),
                            static_cast<uint32_t>(view.height));
    const bool inTime = config_.lastFrame == 0 || mainFrame <= config_.lastFrame;
    const bool wanted = mainFrame > 0 && inTime && (saveFrames_.empty() || saveFrames_.contains(mainFrame));
    if (wanted && file_ && !fileFailed_) save(mainFrame, view);
    if (config_.toNativeWindows && picture.nativeWindow != 0) showInWindow(picture);
    if (mainFrame > 0) {
        const std::lock_guard lock(mutex_);
        totals_.mainFrame = mainFrame;
    }
    config_.done(picture.client, picture.frame);
}

void PictureOutput::save(int64_t frame, const Picture& picture) {
    const auto saved = file_->show(frame, picture);
    if (!saved) {
        config_.say(saved.error().message + "; no further pictures are saved");
        fileFailed_ = true;
        return;
    }
    const std::lock_guard lock(mutex_);
    ++totals_.savedPictures;
    totals_.lastSavedFrame = frame;
}

void PictureOutput::showInWindow(const WindowPicture& picture) {
    const WindowKey key{picture.client, picture.nativeWindow};
    auto found = windows_.find(key);
    if (found == windows_.end()) {
        if (windows_.size() >= kMostWindows) windows_.clear(); // mostly closed ones by then
        auto opened = config_.openWindow(picture.nativeWindow);
        // A window that was closed meanwhile is no news to its user.
        if (!opened && complained_.insert(key).second) config_.say(opened.error().message);
        found = windows_.emplace(key, opened ? std::move(*opened) : nullptr).first;
    }
    if (!found->second) return;
    const auto shown = found->second->show(picture.frame, picture.picture->view());
    if (!shown && complained_.insert(key).second) config_.say(shown.error().message);
}

void PictureOutput::forget(uint32_t client) {
    mainWindow_.clientGone(client);
    std::erase_if(windows_, [&](const auto& entry) { return entry.first.first == client; });
    std::erase_if(complained_, [&](const WindowKey& key) { return key.first == client; });
}

} // namespace mural

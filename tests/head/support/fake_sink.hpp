// Outputs that keep the numbers of their frames, and wait or fail on demand.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "tests/head/support/session_harness.hpp"

namespace mural {

// Frames that sinks received; shared with the test.
struct Shown {
    std::mutex mutex;
    std::condition_variable changed;
    std::map<std::string, std::vector<int64_t>> frames; // by sink
    std::vector<uint32_t> lastPixels;
    std::map<std::string, std::vector<std::vector<uint32_t>>> pixels; // of each frame, by sink
    bool finished = false;
    bool blocked = false;
    bool failing = false;

    size_t count(const std::string& sink) {
        const std::lock_guard lock(mutex);
        return frames[sink].size();
    }
    void block(bool on) {
        const std::lock_guard lock(mutex);
        blocked = on;
        changed.notify_all();
    }
};

class FakeSink : public PictureSink {
public:
    FakeSink(Shown& shown, std::string name) : shown_(shown), name_(std::move(name)) {}
    Result<void> show(int64_t frame, const Picture& picture) override {
        std::unique_lock lock(shown_.mutex);
        shown_.changed.wait_for(lock, std::chrono::seconds(20), [this] { return !shown_.blocked; });
        if (shown_.failing) return Error{"disk full"};
        shown_.frames[name_].push_back(frame);
        shown_.lastPixels.resize(picture.sizeBytes() / 4);
        std::memcpy(shown_.lastPixels.data(), picture.bgra, picture.sizeBytes());
        shown_.pixels[name_].push_back(shown_.lastPixels);
        return {};
    }
    Result<void> finish() override {
        const std::lock_guard lock(shown_.mutex);
        shown_.finished = true;
        return {};
    }
    [[nodiscard]] std::string describe() const override { return name_; }

private:
    Shown& shown_;
    std::string name_;
};

inline void addSinks(SessionHarness& head, Shown& shown) {
    for (auto& behaviour : head.behaviours) behaviour.pictures = true;
    head.options.file = std::make_unique<FakeSink>(shown, "file");
    head.options.openWindow = [&shown](const NativeWindow& window) {
        return Result<std::unique_ptr<PictureSink>>(
            std::make_unique<FakeSink>(shown, "window " + std::to_string(window.id)));
    };
    head.config.out = "out";
}

} // namespace mural

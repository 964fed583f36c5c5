#include "tools/mural/show/show_command.hpp"

#include <algorithm>
#include <csignal>
#include <memory>
#include <poll.h>

#include <fmt/format.h>

#include "common/log/log.hpp"
#include "nodes/launch/program_check.hpp"
#include "nodes/output/outputs.hpp"
#include "tools/mural/end_signals.hpp"

namespace mural::cli {

namespace {

constexpr int64_t kShowSliceMs = 100;
constexpr int kExitCannotShow = 1;

int failedShow(const std::string& why, int status) {
    fmt::print(stderr, "mural show: {}\n", why);
    return status;
}

bool isSignalled(int fd) {
    pollfd polled{fd, POLLIN, 0};
    return poll(&polled, 1, 0) > 0;
}

// Shows and saves received frames.
class ShowSession {
public:
    ShowSession(const ShowOptions& options, remote::WallReceiver& receiver) : receiver_(receiver) {
        if (!options.hasWindows) return;
        WallWindowsConfig windows = options.windows;
        windows.hasBorders = true;
        windows.onInput = [this](const input::InputEvent& event) { receiver_.sendEvent(event); };
        windows_ = std::make_unique<WallSink>(std::move(windows), options.arrange);
    }

    Result<void> openFiles(const std::vector<std::string>& outs) {
        for (const std::string& out : outs) {
            auto file = openOutput(out);
            if (!file) return Error{"--out " + out + ": " + file.error().message};
            files_.push_back(std::move(*file));
        }
        return {};
    }

    // Shows a black wall until the first picture arrives.
    Result<void> showBlack(int width, int height) {
        if (!windows_ || width == 0) return {};
        OwnedPicture black(width, height);
        std::fill_n(black.data(), black.view().sizeBytes(), std::byte{0});
        return windows_->show(0, black.view());
    }

    Result<void> show(const remote::ReceivedFrame& frame) {
        if (windows_)
            if (auto shown = give(*windows_, frame, 0); !shown) return shown;
        const int64_t number = fileNumber(frame);
        for (size_t i = 0; number > lastSaved_ && i < files_.size(); ++i)
            if (auto saved = give(*files_[i], frame, number); !saved) return saved;
        lastSaved_ = std::max(lastSaved_, number);
        return {};
    }

    [[nodiscard]] bool closeRequested() const { return windows_ && windows_->closeRequested(); }

    Result<void> finish() {
        windows_.reset(); // its thread calls the receiver
        Result<void> result;
        for (const auto& file : files_)
            if (auto finished = file->finish(); !finished) result = finished;
        return result;
    }

private:
    static Result<void> give(PictureSink& sink, const remote::ReceivedFrame& frame, int64_t number) {
        const Picture left = frame.pictures[0].view();
        if (frame.eyes == 1) return sink.show(number, left);
        return sink.showPair(number, {left, frame.pictures[1].view()});
    }

    // The frames of a further session follow those of the one before.
    int64_t fileNumber(const remote::ReceivedFrame& frame) {
        const auto wallFrame = static_cast<int64_t>(frame.wallFrame);
        if (frame.session != session_ && base_ + wallFrame <= lastSaved_) base_ = lastSaved_;
        session_ = frame.session;
        return base_ + wallFrame;
    }

    remote::WallReceiver& receiver_;
    std::unique_ptr<WallSink> windows_; // null: none
    std::vector<std::unique_ptr<PictureSink>> files_;
    uint64_t session_ = 0;
    int64_t base_ = 0, lastSaved_ = 0;
};

} // namespace

int showCommand(const ShowArguments& arguments) {
    const auto options = showOptionsFrom(arguments);
    if (!options) return failedShow(options.error().message, launch::kExitUsage);
    auto signals = endSignals();
    if (!signals) return failedShow(signals.error().message, kExitCannotShow);
    std::signal(SIGPIPE, SIG_IGN);
    auto receiver = remote::WallReceiver::open(options->receiver);
    if (!receiver) return failedShow("--listen: " + receiver.error().message, launch::kExitUsage);
    ShowSession session(*options, **receiver);
    if (auto opened = session.openFiles(options->outs); !opened)
        return failedShow(opened.error().message, launch::kExitUsage);
    auto shown = session.showBlack(options->receiver.limits.width, options->receiver.limits.height);
    log::info(log::Topic::Output, "waits for pictures at ", (*receiver)->describe(),
              "; start mural run --send there, with the same secret");
    remote::ReceivedFrame frame;
    while (shown && !isSignalled(signals->get()) && !session.closeRequested()) {
        if (!(*receiver)->next(frame, Deadline::inMs(kShowSliceMs))) continue;
        shown = session.show(frame);
        if (shown) (*receiver)->shown(frame);
    }
    if (session.closeRequested()) {
        input::InputEvent close;
        close.kind = input::InputKind::Close;
        (*receiver)->sendEvent(close);
        (void)(*receiver)->next(frame, Deadline::inMs(0)); // sends it
    }
    (*receiver)->end(session.closeRequested() ? "its window was closed" : "mural show ends");
    const auto finished = session.finish();
    if (!shown) return failedShow(shown.error().message, kExitCannotShow);
    return finished ? 0 : failedShow(finished.error().message, kExitCannotShow);
}

} // namespace mural::cli

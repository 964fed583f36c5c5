#include <cstdio>
#include <exception>
#include <utility>

#include <mural/mural.hpp>

#include "native/runtime/node_main.hpp"

namespace mural {

namespace {

constexpr int kFailed = 1, kNoSession = 2;
constexpr int64_t kIdleMs = 10;       // between calls of update() that draw nothing
constexpr int64_t kFinishMs = 60'000; // for the last frames

void complain(const char* program, const std::string& text) { std::fprintf(stderr, "%s: %s\n", program, text.c_str()); }

// Draws frames until the application or the session ends. Nodes that draw nothing for a while, because they are
// restarted or stopped, do not end it.
Result<void> drawFrames(Session& session, Application& application, const char* name) {
    bool hasComplained = false;
    const int64_t startNs = monotonicNowNs();
    int64_t lastNs = startNs;
    FrameClock clock;
    clock.frame = 1;
    while (session.isRunning()) {
        const int64_t nowNs = monotonicNowNs();
        clock.seconds = static_cast<double>(nowNs - startNs) / kNsPerS;
        clock.sinceLast = static_cast<double>(nowNs - lastNs) / kNsPerS;
        lastNs = nowNs;
        switch (application.update(session, clock)) {
        case Next::End: {
            auto finished = session.finishAll(Deadline::inMs(kFinishMs));
            return finished || !session.isRunning() ? Result<void>() : finished;
        }
        case Next::Wait: session.wait(Deadline::inMs(kIdleMs)); break;
        case Next::Frame: {
            auto frame = session.startFrame();
            if (frame) {
                clock.frame = *frame + 1;
                hasComplained = false;
            } else if (session.isRunning() && !std::exchange(hasComplained, true)) {
                complain(name, frame.error().message + "; waiting");
            }
            break;
        }
        }
    }
    return {};
}

// Runs a function of the program. An exception becomes an error.
template <class Function> Result<void> guarded(Function&& function) {
    try {
        return function();
    } catch (const std::exception& e) {
        return Error{std::string("the application has thrown: ") + e.what()};
    } catch (...) {
        return Error{"the application has thrown an unknown exception"};
    }
}

} // namespace

int run(int argc, char** argv, const Program& program) {
    const char* const name = argc > 0 ? argv[0] : "mural";
    if (const auto status = native::runNodeIfRequested(argc, argv, program)) return *status;
    std::unique_ptr<Session> joined; // outlives the application and its objects
    std::unique_ptr<Application> application;
    Next next = Next::Frame;
    const auto parsed = guarded([&]() -> Result<void> {
        application = program.application ? program.application() : nullptr;
        if (!application) return Error{"the program makes no Application; set Program::application"};
        auto read = application->parse(argc, argv);
        if (!read) return read.error();
        next = *read;
        return {};
    });
    if (!parsed) {
        complain(name, parsed.error().message);
        return kFailed;
    }
    if (next == Next::End) return 0;
    auto opened = Session::open(argc, argv, program);
    if (!opened) {
        complain(name, opened.error().message);
        return kNoSession;
    }
    joined = std::move(*opened);
    Session* const session = joined.get();
    auto ran = guarded([&]() -> Result<void> {
        auto started = application->start(*session, argc, argv);
        return started ? drawFrames(*session, *application, name) : started;
    });
    if (!ran) complain(name, ran.error().message);
    const auto ended = guarded([&] {
        if (application) application->end(*session);
        return Result<void>();
    });
    if (!ended) complain(name, ended.error().message);
    return ran && ended ? 0 : kFailed;
}

} // namespace mural

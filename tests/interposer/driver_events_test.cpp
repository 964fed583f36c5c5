// Driver events of the nodes reach the program once, and only if its own driver has not reported them.
#include <gtest/gtest.h>

#include <cstring>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"
#include "interposer/diagnostics/log.hpp"
#include "interposer/diagnostics/driver_events.hpp"
#include "interposer/encode/real_gl.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

namespace {
capture::CaptureHeader shared{};
std::deque<std::pair<wire::DriverEvent, std::string>> coming;
std::vector<std::string> inserted;
GLDEBUGPROC driverCallback = nullptr;
const void* driverUser = nullptr;
GLenum pendingError = GL_NO_ERROR;
std::string logged;
} // namespace

// ---- functions that driver_events.cpp calls

GlFunctions gReal{};
Session* Session::current() {
    static Session session;
    session.header_ = &shared;
    return &session;
}
bool Session::takeDriverEvents(wire::DriverEvent& event, char* text) {
    if (coming.empty()) return false;
    event = coming.front().first;
    std::memcpy(text, coming.front().second.c_str(), coming.front().second.size() + 1);
    coming.pop_front();
    ++driverEventsTaken_;
    return true;
}
GLenum driverError() { return std::exchange(pendingError, GL_NO_ERROR); }
void stashError(Context& c, GLenum error) {
    if (!c.stashedError) c.stashedError = error;
}
void say(const char* format, ...) { logged = format; }

namespace {

class DriverEvents : public ::testing::Test {
protected:
    void SetUp() override {
        gReal.glDebugMessageCallback = [](void* callback, const void* user) {
            driverCallback = reinterpret_cast<GLDEBUGPROC>(callback);
            driverUser = user;
        };
        gReal.glDebugMessageInsert = [](GLenum, GLenum, GLuint, GLenum, GLsizei, const GLchar* text) {
            inserted.emplace_back(text);
        };
        inserted.clear();
        logged.clear();
        context_.id = 3;
        t_.context = &context_;
    }
    void comes(wire::DriverEventKind kind, const std::string& text = "", uint32_t type = 0, uint32_t context = 3) {
        coming.push_back({{1, context, static_cast<uint32_t>(kind), GL_DEBUG_SOURCE_API, type, 5, GL_DEBUG_SEVERITY_LOW,
                           static_cast<uint32_t>(text.size())},
                          text});
        shared.driverEventTail.fetch_add(1);
    }
    void message(const std::string& text, uint32_t type = GL_DEBUG_TYPE_PERFORMANCE, uint32_t context = 3) {
        comes(wire::DriverEventKind::DebugMessage, text, type, context);
        takeDriverEvents(t_);
    }
    void fromDriver(const char* text) {
        driverCallback(GL_DEBUG_SOURCE_API, GL_DEBUG_TYPE_PERFORMANCE, 9, GL_DEBUG_SEVERITY_LOW, -1, text, driverUser);
    }

    static void APIENTRY record(GLenum, GLenum, GLuint, GLenum, GLsizei length, const GLchar* text, const void* user) {
        static_cast<std::vector<std::string>*>(const_cast<void*>(user))
            ->emplace_back(length < 0 ? std::string(text) : std::string(text, static_cast<size_t>(length)));
    }
    std::vector<std::string> received_;
    Context context_;
    ThreadState t_;
};

TEST_F(DriverEvents, deliversMessagesToTheCallbackOnce) {
    listen(context_, record, &received_);
    message("slow");
    EXPECT_EQ(received_, std::vector<std::string>({"slow"}));
    fromDriver("slow"); // the program always receives messages of its own driver
    EXPECT_EQ(received_.size(), 2u);
    fromDriver("wrong");
    message("wrong"); // the same call on the nodes
    EXPECT_EQ(received_, std::vector<std::string>({"slow", "slow", "wrong"}));
    message("wrong"); // found only when drawing
    EXPECT_EQ(received_.size(), 4u);
    EXPECT_TRUE(inserted.empty());
}

TEST_F(DriverEvents, leavesMessagesToTheDriverWithoutACallback) {
    message("slow");
    message("error", GL_DEBUG_TYPE_ERROR); // already in its log
    EXPECT_EQ(inserted, std::vector<std::string>({"slow"}));
}

TEST_F(DriverEvents, defersMessagesOfOtherContextsToTheirThread) {
    listen(context_, record, &received_);
    message("for another", GL_DEBUG_TYPE_PERFORMANCE, 4);
    EXPECT_TRUE(received_.empty());
    for (int i = 0; i < 200; ++i) message("nobody takes this", GL_DEBUG_TYPE_PERFORMANCE, 77);
    message("mine");
    EXPECT_EQ(received_, std::vector<std::string>({"mine"}));
    context_.id = 77;
    comes(wire::DriverEventKind::DebugMessage, "mine", 0);
    takeDriverEvents(t_);
    EXPECT_GE(received_.size(), 2u);
}

TEST_F(DriverEvents, setsOutOfMemoryWhenTheDriverReportedNone) {
    comes(wire::DriverEventKind::OutOfMemory);
    takeDriverEvents(t_);
    EXPECT_TRUE(context_.outOfMemoryDue);
    EXPECT_EQ(context_.stashedError, GLenum{GL_NO_ERROR});
}

TEST_F(DriverEvents, hidesOutOfMemoryAfterAnEarlierError) {
    for (const GLenum own : {GL_OUT_OF_MEMORY, GL_INVALID_OPERATION}) {
        pendingError = own; // error of the driver, not fetched yet
        comes(wire::DriverEventKind::OutOfMemory);
        takeDriverEvents(t_);
        EXPECT_EQ(std::exchange(context_.stashedError, 0), own);
        EXPECT_FALSE(context_.outOfMemoryDue);
    }
    context_.errorsReported = 2; // the call precedes the second error
    comes(wire::DriverEventKind::OutOfMemory, "", 1);
    takeDriverEvents(t_);
    EXPECT_FALSE(context_.outOfMemoryDue);
    comes(wire::DriverEventKind::OutOfMemory, "", 2);
    takeDriverEvents(t_);
    EXPECT_TRUE(context_.outOfMemoryDue);
}

TEST_F(DriverEvents, reportsAResetStatusWhenRequested) {
    comes(wire::DriverEventKind::ContextLost, "", GL_INNOCENT_CONTEXT_RESET);
    takeDriverEvents(t_);
    EXPECT_EQ(context_.resetStatus, GLenum{GL_NO_ERROR});
    EXPECT_FALSE(logged.empty());
    context_.losesOnReset = true;
    comes(wire::DriverEventKind::ContextLost, "", GL_INNOCENT_CONTEXT_RESET);
    takeDriverEvents(t_);
    EXPECT_EQ(context_.resetStatus, GLenum{GL_INNOCENT_CONTEXT_RESET});
    EXPECT_EQ(context_.stashedError, GLenum{GL_CONTEXT_LOST});
}

} // namespace
} // namespace mural

// The centre of the page: its viewers, their roles, and their requests to the head. Knows no HTTP. Used by the thread
// of its io_context.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "common/base/result.hpp"
#include "nodes/input/program_display.hpp"
#include "tools/mural/page/access/failure_limit.hpp"
#include "tools/mural/page/access/link_table.hpp"
#include "tools/mural/page/access/role.hpp"
#include "tools/mural/page/hub/head_link.hpp"
#include "tools/mural/page/hub/topic_fan.hpp"
#include "tools/mural/page/hub/viewer_socket.hpp"
#include "tools/mural/page/input/input_lease.hpp"
#include "tools/mural/page/pictures/picture_hub.hpp"
#include "tools/mural/page/protocol/client_message.hpp"
#include "tools/mural/page/protocol/rate_limit.hpp"

namespace mural::input {
class ProgramInput;
}

namespace mural::page {

class CursorWatch;

inline constexpr size_t kMaxViewers = 64;

struct HubConfig {
    std::string controlPath; // of the head's control socket
    nlohmann::json hello;    // members of the head's first line
    std::string address;     // of the page, "http://127.0.0.1:8787/"; links begin with it
    PictureLimits pictures;
    InputMode inputMode = InputMode::Click; // --control
    bool reachesUserDisplay = false;        // --input-on-display
};

class PageHub {
public:
    using Json = nlohmann::json;
    using OnReply = std::function<void(Json reply)>;
    enum class Login { Accepted, Denied, TooMany };
    struct Access {
        Login login = Login::Denied;
        LinkTable::Known link;
    };

    // onEnd: called once when the session has ended.
    static Result<std::unique_ptr<PageHub>> create(boost::asio::io_context& io, HubConfig config,
                                                   std::function<void()> onEnd);
    PageHub(const PageHub&) = delete;
    PageHub& operator=(const PageHub&) = delete;
    ~PageHub();

    // Adds a socket whose hello is awaited. Returns its number; 0: too many viewers.
    int join(ViewerSocket& socket, const std::string& address);
    void received(int viewer, std::string_view text);
    void left(int viewer);

    // Checks the token of an HTTP request. Failures count for the address.
    Access access(std::string_view token, const std::string& address);
    // Performs an operation for a role and calls `onReply` with {"ok": …}. who: for the log.
    void perform(Role role, const std::string& who, const std::string& operation, const Json& arguments,
                 OnReply onReply);
    // Performs an operation of the head without a check.
    void askHead(const std::string& operation, const Json& arguments, OnReply onReply);

    LinkTable& links() { return links_; }
    // Keeps the links for a later page of this session. Call after each change of them.
    void keepLinks();
    PictureHub& pictures() { return pictures_; }
    struct Numbers {
        std::array<size_t, 3> viewers{}; // by role
        uint64_t invalidMessages = 0, deniedRequests = 0;
        uint64_t inputs = 0, droppedInputs = 0;
        std::array<PictureHub::Totals, kPictureClasses> pictures{};
    };
    [[nodiscard]] Numbers numbers() const;
    // Returns whether the head's control thread has replied within the last seconds.
    [[nodiscard]] bool isHeadAlive() const;
    [[nodiscard]] const Json& hello() const { return config_.hello; }
    // Returns the latest log lines of the head and events that name the node, the oldest first.
    [[nodiscard]] std::string nodeLog(int node, size_t lines) const;

private:
    struct Viewer {
        ViewerSocket* socket = nullptr;
        std::string address;
        bool isKnown = false; // has sent a hello
        LinkTable::Known link;
        std::string name;
        bool decodesVideo = false;
        int64_t helloUntilNs = 0;
        RateLimit requests{20}, inputs{500};
        size_t waiting = 0; // requests without a reply
    };

    PageHub(boost::asio::io_context& io, HubConfig config, std::function<void()> onEnd, std::shared_ptr<HeadLink> quick,
            std::shared_ptr<HeadLink> slow);
    void begin();
    void tick();
    void checkViewers(int64_t nowNs);
    void subscribeToHead();
    void fetchFrames(int64_t nowNs);
    void fetchOutputs(int64_t nowNs);
    void takeMessage(const Json& message);
    void remember(const Json& message);
    void end();

    void take(int viewer, const HelloMessage& hello);
    void take(int viewer, const RequestMessage& request);
    void take(int viewer, const input::InputEvent& event);
    void take(int viewer, const AckMessage& ack);
    void take(int viewer, const PingMessage& ping);
    void take(int viewer, const InvalidMessage& invalid);
    // Performs operations that belong to a viewer's socket. Returns nullopt for all others.
    std::optional<Json> ofViewer(int viewer, const RequestMessage& request);
    // Performs operations of the page. Returns false for operations of the head.
    bool ofPage(const std::string& operation, const Json& arguments, const OnReply& onReply);
    void findProgram(int64_t nowNs);
    void watchCursor(int64_t nowNs);
    void takeProgram(const Json& program);
    Json takeInput(int viewer, const Json& arguments);
    Json releaseInput(int viewer, const Json& arguments);
    void changeHolder();
    Json createLink(const Json& arguments);
    Json revokeLink(const Json& arguments);
    void describeWall(OnReply onReply);
    void reply(int viewer, const Json& id, Json reply);
    void send(int viewer, const Json& message);
    void closeViewer(int viewer, uint16_t code, const std::string& why);
    void announceViewers();
    [[nodiscard]] Json viewersJson() const;

    const HubConfig config_;
    std::function<void()> onEnd_;
    const std::shared_ptr<HeadLink> quick_; // reading operations and topics
    const std::shared_ptr<HeadLink> slow_;  // operations that may take a minute
    LinkTable links_;
    FailureLimit failures_;
    TopicFan fan_;
    PictureHub pictures_;
    InputLease lease_;
    std::unique_ptr<input::ProgramInput> input_;
    std::unique_ptr<CursorWatch> cursor_;
    std::optional<input::ProgramDisplay> display_; // of the program; nullopt: unknown, or of a user
    int knownHolder_ = 0;                          // announced to the viewers
    int64_t programAskedNs_ = 0;
    std::string inputProblem_; // why the program gets no input; empty: it gets it
    uint64_t inputs_ = 0, droppedInputs_ = 0;
    std::map<int, Viewer> viewers_;
    int lastViewer_ = 0;
    boost::asio::steady_timer timer_;
    std::array<int64_t, 3> subscribedMs_{}; // intervals of the head's topics; 0: not subscribed
    uint64_t nextFrame_ = 0;                // of the timeline; 0: nobody subscribes
    int64_t framesAtNs_ = 0;
    bool isFetchingFrames_ = false;
    Json wall_; // latest description, of the topic `outputs`; null: none
    int64_t wallAtNs_ = 0, outputsAtNs_ = 0;
    bool isFetchingOutputs_ = false, isProofDue_ = false;
    int64_t askedAtNs_ = 0, repliedAtNs_ = 0; // of the check that the head is alive
    std::deque<std::string> log_;             // latest lines
    uint64_t invalidMessages_ = 0, deniedRequests_ = 0;
    bool hasEnded_ = false;
};

} // namespace mural::page

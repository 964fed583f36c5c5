// Pictures for all viewers. The hub requests each class of each source while a viewer watches, and encodes it once per
// coding. Codings are JPEG by quality, PNG of pictures that rest, and one H.264 stream. The flow control of each viewer
// decides when it is sent. Used by the thread of its io_context; encoding has a thread of its own.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>

#include "common/base/result.hpp"
#include "tools/mural/page/hub/viewer_socket.hpp"
#include "tools/mural/page/input/cursor_watch.hpp"
#include "tools/mural/page/pictures/picture_class.hpp"
#include "tools/mural/page/pictures/picture_source.hpp"
#include "tools/mural/page/pictures/video_encoder.hpp"
#include "tools/mural/page/pictures/viewer_flow.hpp"
#include "tools/mural/page/protocol/picture_part.hpp"

namespace mural::page {

class PictureHub {
public:
    // A class of pictures whose viewers have seen no later one for this time gets the still.
    static constexpr int64_t kRestNs = 400'000'000;
    // Key frames of a stream are large, so viewers that need one share it.
    static constexpr int64_t kKeyEveryNs = 1'000'000'000;

    struct Snapshot {
        int maxWidth = 0;
        int quality = 90;
        bool isPng = false;
    };
    struct Totals {
        uint64_t encodes = 0, sent = 0, bytes = 0;
    };

    // path: of the head's socket for pages.
    PictureHub(boost::asio::io_context& io, std::string path, const PictureLimits& limits);
    PictureHub(const PictureHub&) = delete;
    PictureHub& operator=(const PictureHub&) = delete;
    ~PictureHub();

    // Performs the operation `preview`. Returns an empty object. Errors: invalid arguments; the head gives no pictures.
    // decodesVideo: the viewer gets H.264, beginning with a key frame.
    Result<nlohmann::json> preview(int viewer, ViewerSocket& socket, bool decodesVideo,
                                   const nlohmann::json& arguments);
    void acknowledged(int viewer, uint64_t frame, int64_t nowNs);
    void forget(int viewer);
    // The pointer of the program's display, for viewers of the wall and of the display.
    void setCursor(const CursorState& cursor);
    // The program's private display; nullopt: not known yet. problem: why viewers may not see it; empty: they may.
    void setDisplay(std::optional<input::ProgramDisplay> display, const std::string& problem);
    // Whether a viewer needs the pointer, or the display itself.
    [[nodiscard]] bool isDisplayWatched() const;
    // The program has got input of this viewer up to this number.
    void inputReached(int viewer, uint32_t number);

    // Sends the requests and pictures that are due. Call often while isWanted().
    void tick(int64_t nowNs);
    [[nodiscard]] bool isWanted() const { return !viewers_.empty(); }

    // Encodes the present picture of the wall once.
    void snapshot(const Snapshot& snapshot, const std::function<void(Result<std::string> bytes)>& onDone);

    [[nodiscard]] const std::array<Totals, kPictureClasses>& totals() const { return totals_; }
    // Size of the wall's picture; 0: unknown, because no viewer has requested it.
    [[nodiscard]] std::pair<int, int> wallSize() const { return {wallWidth_, wallHeight_}; }

private:
    using Key = std::pair<uint32_t, PictureClass>; // source (PictureWish), class
    using Encoded = std::shared_ptr<const std::string>;
    // Keys of Channel::encoded beside the qualities of JPEG: stills for viewers whose link is slow, and for all others.
    static constexpr int kFine = 1000, kLossless = 1001;

    // Pictures of one class of one source.
    struct Channel {
        std::shared_ptr<PictureSource> feed;
        int64_t wishedNs = 0; // the last wish
        FeedPicture latest;
        int64_t arrivedNs = 0;
        std::map<int, Encoded> encoded;      // of the latest picture, by quality; null: in progress
        std::shared_ptr<VideoEncoder> video; // null: no viewer decodes it. Used by the encoder's thread
        bool hasVideoFailed = false, isEncodingVideo = false;
        uint64_t videoFrame = 0; // the latest one that the encoder has got
        int64_t keyNs = 0;       // the latest key frame
    };
    struct Watcher {
        ViewerSocket* socket = nullptr;
        Key key;
        ViewerFlow flow;
        bool decodesVideo = false, needsKey = true;
        std::shared_ptr<const std::string> cursorShape; // that it has
        uint64_t sentFrame = 0, stillFrame = 0;
        uint32_t lastInput = 0;
    };

    void pump(const Key& key, Channel& channel, int64_t nowNs);
    void wishNext(const Key& key, Channel& channel, int64_t nowNs);
    void arrived(const Key& key, FeedPicture picture);
    void encode(const Key& key, Channel& channel, int quality);
    void send(Watcher& watcher, const Channel& channel, const std::string& header, const Encoded& bytes, int64_t nowNs);
    bool deliver(Watcher& watcher, const Key& key, Channel& channel, int quality, bool isStill, int64_t nowNs);
    // H.264 (video_stream.cpp)
    static bool usesVideo(const Watcher& watcher, const Key& key, const Channel& channel);
    void encodeVideo(const Key& key, Channel& channel, bool wantsKey, int64_t nowNs);
    void takeUnit(const Key& key, uint64_t frame, Result<VideoUnit> unit);
    void count(const Key& key, size_t bytes);
    static bool showsCursor(const Key& key);
    void sendCursor(Watcher& watcher);
    Result<std::shared_ptr<PictureSource>> sourceFor(uint32_t source);

    boost::asio::io_context& io_;
    const std::string path_;
    const PictureLimits limits_;
    std::map<int, Watcher> viewers_;
    std::map<Key, Channel> channels_;
    std::array<Totals, kPictureClasses> totals_{};
    int wallWidth_ = 0, wallHeight_ = 0;
    CursorState cursor_;
    std::optional<input::ProgramDisplay> display_;
    std::string displayProblem_;
    std::shared_ptr<int> alive_ = std::make_shared<int>(0); // expires with this object, for tasks of the encoder
    boost::asio::thread_pool encoder_{1};
};

} // namespace mural::page

#include "nodes/remote_wall/wall_message.hpp"

#include "nodes/input/input_event_bytes.hpp"
#include "objects/wire/message_bytes.hpp"

namespace mural::remote {

namespace {

using objects::MessageReader;
using objects::MessageWriter;

enum class Kind : uint8_t { Hello, Tile, FrameEnd, Ack, Want, Event, Bye };

constexpr size_t kMaxText = 64;
constexpr size_t kMaxReason = 512;
constexpr uint32_t kMagic = 0x4c57554d; // "MUWL"

class Encoder {
public:
    explicit Encoder(archive::ByteBuffer& out) : out_(out) {}

    void operator()(const Hello& hello) {
        begin(Kind::Hello);
        out_.fixed(kMagic);
        out_.number(hello.version);
        out_.text(hello.name.substr(0, kMaxText));
        out_.text(hello.codec.substr(0, kMaxText));
        out_.fixed(hello.session);
        put(hello.width), put(hello.height), put(hello.eyes), put(hello.tile);
        out_.number(hello.source), out_.number(hello.sources);
    }
    void operator()(const Tile& tile) {
        begin(Kind::Tile);
        out_.number(tile.frame);
        put(tile.size);
        put(tile.eye);
        for (const int value : {tile.area.x, tile.area.y, tile.area.w, tile.area.h}) put(value);
        out_.byte(tile.codec);
        out_.raw(tile.bytes);
    }
    void operator()(const FrameEnd& end) {
        begin(Kind::FrameEnd);
        out_.number(end.frame);
        put(end.size);
        out_.number(end.tiles);
        out_.byte(end.isWhole ? 1 : 0);
        out_.number(end.wallFrame);
    }
    void operator()(const Ack& ack) {
        begin(Kind::Ack);
        out_.number(ack.frame), out_.number(ack.shownNs);
    }
    void operator()(const Want& want) {
        begin(Kind::Want);
        put(want.rate), put(want.width), put(want.height);
        out_.byte(want.isWhole ? 1 : 0);
    }
    void operator()(const Event& event) {
        begin(Kind::Event);
        input::putEvent(out_, event.input);
    }
    void operator()(const Bye& bye) {
        begin(Kind::Bye);
        out_.byte(bye.isFinal ? 1 : 0);
        out_.text(bye.reason.substr(0, kMaxReason));
    }

private:
    void begin(Kind kind) { out_.byte(static_cast<uint8_t>(kind)); }
    void put(int value) { out_.number(static_cast<uint64_t>(value < 0 ? 0 : value)); }
    void put(const PictureSize& size) { put(size.width), put(size.height), put(size.eyes); }

    MessageWriter out_;
};

int intUpTo(MessageReader& in, int most) { return static_cast<int>(in.numberUpTo(static_cast<uint64_t>(most))); }

bool flagOf(MessageReader& in) { return in.numberUpTo(1) != 0; }

PictureSize sizeOf(MessageReader& in) {
    PictureSize size;
    size.width = intUpTo(in, kMaxPictureSide);
    size.height = intUpTo(in, kMaxPictureSide);
    size.eyes = intUpTo(in, kMaxEyes);
    if (size.width < 1 || size.height < 1 || size.eyes < 1 || size.pixels() > kMaxPicturePixels) in.fail();
    return size;
}

Hello helloOf(MessageReader& in) {
    Hello hello;
    if (in.fixed<uint32_t>() != kMagic) in.fail();
    hello.version = static_cast<uint32_t>(in.numberUpTo(UINT32_MAX));
    if (hello.version != kWallVersion) {
        (void)in.rest();
        return hello;
    }
    hello.name = in.text(kMaxText);
    hello.codec = in.text(kMaxText);
    hello.session = in.fixed<uint64_t>();
    hello.width = intUpTo(in, kMaxPictureSide);
    hello.height = intUpTo(in, kMaxPictureSide);
    hello.eyes = intUpTo(in, kMaxEyes);
    hello.tile = intUpTo(in, kMaxTile);
    hello.source = static_cast<uint32_t>(in.numberUpTo(kMaxSources - 1));
    hello.sources = static_cast<uint32_t>(in.numberUpTo(kMaxSources));
    if (hello.source >= hello.sources) in.fail();
    return hello;
}

Tile tileOf(MessageReader& in) {
    Tile tile;
    tile.frame = in.number();
    tile.size = sizeOf(in);
    tile.eye = intUpTo(in, kMaxEyes - 1);
    tile.area.x = intUpTo(in, kMaxPictureSide);
    tile.area.y = intUpTo(in, kMaxPictureSide);
    tile.area.w = intUpTo(in, kMaxTile);
    tile.area.h = intUpTo(in, kMaxTile);
    tile.codec = in.byte();
    tile.bytes = in.rest();
    const PixelViewport picture{0, 0, tile.size.width, tile.size.height};
    const bool isSound = tile.eye < tile.size.eyes && !tile.area.empty() && picture.contains(tile.area) &&
                         tile.bytes.size() <= 4 * static_cast<size_t>(tile.area.area());
    if (!isSound) in.fail();
    return tile;
}

FrameEnd frameEndOf(MessageReader& in) {
    FrameEnd end;
    end.frame = in.number();
    end.size = sizeOf(in);
    end.tiles = static_cast<uint32_t>(in.numberUpTo(UINT32_MAX));
    end.isWhole = flagOf(in);
    end.wallFrame = in.number();
    return end;
}

Message bodyOf(Kind kind, MessageReader& in) {
    switch (kind) {
    case Kind::Hello: return helloOf(in);
    case Kind::Tile: return tileOf(in);
    case Kind::FrameEnd: return frameEndOf(in);
    case Kind::Ack: {
        const uint64_t frame = in.number();
        return Ack{frame, in.number()};
    }
    case Kind::Want: {
        Want want;
        want.rate = intUpTo(in, kMaxRate);
        want.width = intUpTo(in, kMaxPictureSide);
        want.height = intUpTo(in, kMaxPictureSide);
        want.isWhole = flagOf(in);
        return want;
    }
    case Kind::Event: return Event{input::readEvent(in)};
    case Kind::Bye: {
        const bool isFinal = flagOf(in);
        Bye bye{in.text(kMaxReason), isFinal};
        for (char& c : bye.reason)
            if (static_cast<unsigned char>(c) < ' ') c = ' '; // one line
        return bye;
    }
    }
    in.fail();
    return Bye{};
}

} // namespace

std::vector<std::byte> encode(const Message& message) {
    archive::ByteBuffer buffer;
    std::visit(Encoder(buffer), message);
    const auto bytes = buffer.bytes();
    return {bytes.begin(), bytes.end()};
}

Result<Message> parseMessage(std::span<const std::byte> bytes) {
    MessageReader in(bytes);
    const auto kind = static_cast<Kind>(in.numberUpTo(static_cast<uint64_t>(Kind::Bye)));
    Message message = bodyOf(kind, in);
    if (!in.atEnd()) return Error{"it sent a malformed message; install the same version of mural on both machines"};
    return message;
}

} // namespace mural::remote

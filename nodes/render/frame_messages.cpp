#include "nodes/render/frame_messages.hpp"

namespace mural {

wire::PictureHeader pictureHeaderOf(const PlayerOutputs::Frame& frame) {
    wire::PictureHeader h{};
    h.client = frame.client;
    h.window = frame.window;
    h.frame = frame.frame;
    h.x = frame.region.x;
    h.y = frame.region.y;
    h.w = frame.region.w;
    h.h = frame.region.h;
    h.windowWidth = static_cast<uint32_t>(frame.picture.w);
    h.windowHeight = static_cast<uint32_t>(frame.picture.h);
    h.nativeLow = frame.config.nativeLow;
    h.nativeHigh = frame.config.nativeHigh;
    h.format = static_cast<uint32_t>(frame.format);
    return h;
}

wire::FrameDoneMessage frameDoneMessageOf(const PlayerOutputs::Frame& frame) {
    wire::FrameDoneMessage done{};
    done.client = frame.client;
    done.window = frame.window;
    done.frame = frame.frame;
    done.width = frame.config.width;
    done.height = frame.config.height;
    done.flags = (frame.drawnWhole ? wire::kDrawnWhole : 0) | (frame.keepsPicture ? wire::kKeepsPicture : 0) |
                 (frame.notSplit ? wire::kNotSplit : 0) | (frame.keepsAreas ? wire::kKeepsAreas : 0) |
                 (frame.isUnzoomed ? wire::kDrawnUnzoomed : 0);
    done.areas = frame.areas;
    done.shares = frame.shares;
    return done;
}

} // namespace mural

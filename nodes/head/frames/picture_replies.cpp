#include "nodes/head/frames/picture_replies.hpp"

#include <algorithm>

namespace mural {

namespace {

constexpr int kLargestSide = 32767; // of a window, and of coordinates in the X protocol

bool isValid(const PixelFormat& format) {
    const bool pads = format.rowPadBits == 8 || format.rowPadBits == 16 || format.rowPadBits == 32;
    return pads && format.depth >= 1 && format.depth <= format.bitsPerPixel && format.bitsPerPixel <= 32;
}

} // namespace

Reply ownPictureReply(uint32_t frame, uint32_t window, const PixelFormat& format, const Picture& picture) {
    Reply reply;
    reply.header.requestId = frame;
    reply.header.kind = capture::kPictureReply;
    reply.header.x = static_cast<int32_t>(window);
    reply.header.failed = 1;
    auto converter =
        isValid(format) ? PixelConverter::make(format) : Result<PixelConverter>(Error{"an invalid format"});
    const int width = std::min(picture.width, kLargestSide);
    const int height = std::min(picture.height, kLargestSide);
    if (!converter || width <= 0 || height <= 0) return reply;
    const size_t rowBytes = converter->rowBytes(width);
    reply.bytes = ByteBuffer::ofSize(rowBytes * static_cast<size_t>(height));
    if (reply.bytes.size() == 0) return reply;
    for (int line = 0; line < height; ++line) // X has the topmost row first
        converter->convertRow(picture.format, picture.row(picture.height - 1 - line), width,
                              reply.bytes.data() + rowBytes * static_cast<size_t>(line));
    reply.header.w = width;
    reply.header.h = height;
    reply.header.sizeBytes = reply.bytes.size();
    reply.header.failed = 0;
    return reply;
}

} // namespace mural

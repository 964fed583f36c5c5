// Puts pictures into the program's own windows, through the connection that holds a grab of their X server
// (interposer/x11/server_grabs.hpp). The head sends the pictures as replies, in the window's own format.
#pragma once

#include <cstdint>
#include <xcb/xcb.h>

#include "common/ipc/capture_ring.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

struct Window;

// Requests the picture of a frame from the head, if this process has grabbed the window's server and must put the
// picture itself (Session::takePictures). Returns false if the head shows the picture. Call before the records of the
// frame.
bool announceOwnPut(capture::CaptureHeader& header, const Window& w, uint32_t frame);

// Puts a received picture into its window. The X server reports no error of it to the program.
void putOwnPicture(const wire::ReplyHeader& picture, const std::byte* pixels);

// Drops the cached properties of windows on this connection, which may be outdated.
void forgetOwnPuts(xcb_connection_t* c);

} // namespace mural

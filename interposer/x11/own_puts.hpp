// Puts pictures into the program's own windows, through the connection that holds a grab of their X server
// (interposer/x11/server_grabs.hpp). The head sends the pictures as replies, in the window's own format.
#pragma once

#include <cstdint>
#include <xcb/xcb.h>

#include "common/ipc/capture_ring.hpp"
#include "streamcodec/wire/replies.hpp"

namespace mural {

struct Window;

// Call before the records of a frame of this window. Returns true if the head will send the picture
// (Session::takePictures). Returns false if the head shows it, because no connection of this process has grabbed the
// server.
bool announceOwnPut(capture::CaptureHeader& header, const Window& w, uint32_t frame);

// Puts a received picture into its window. The X server reports no error of it to the program.
void putOwnPicture(const wire::ReplyHeader& picture, const std::byte* pixels);

// Drops the cached properties of windows on this connection, which may be outdated.
void forgetOwnPuts(xcb_connection_t* c);

} // namespace mural

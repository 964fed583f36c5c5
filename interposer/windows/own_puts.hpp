// Pictures that the program puts into its own windows, through the connection that holds a grab of their X server
// (interposer/windows/server_grabs.hpp). The head sends them as replies, in the window's own format.
#pragma once

#include <cstdint>
#include <xcb/xcb.h>

#include "common/capture_ring.hpp"
#include "streamcodec/wire.hpp"

namespace mural {

struct Window;

// Before the records of a frame of this window. True: the head will send the picture (Session::takePictures); false: it
// shows the picture itself, as no connection of this process has grabbed the server.
bool announceOwnPut(capture::CaptureHeader& header, const Window& w, uint32_t frame);

// Puts a picture that has come into its window. The X server reports no error of it to the program.
void putOwnPicture(const wire::ReplyHeader& picture, const std::byte* pixels);

// What is known of windows through this connection may be out of date.
void forgetOwnPuts(xcb_connection_t* c);

} // namespace mural

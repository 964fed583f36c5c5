// `mural run --verify`: compares what the nodes drew with what the program's own context drew.
#pragma once

namespace mural {

struct ThreadState;
struct Window;

// Both pictures of the window's back buffer; the counts go to the head's report.
void verifyFrame(ThreadState& t, Window& w);

} // namespace mural

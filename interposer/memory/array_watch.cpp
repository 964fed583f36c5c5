#include "interposer/memory/array_watch.hpp"

#include "interposer/readback/node_requests.hpp"
#include "interposer/context/context.hpp"

namespace mural {

ArrayWatch::ArrayWatch(const ThreadState& t, GLuint array, uint32_t slot, uint32_t count)
    : array_(array), first_(slot), end_(slot) {
    constexpr uint32_t kSlots = client_arrays::kSlots;
    if (!t.context || slot >= kSlots || !t.context->arrays.knows(array)) return;
    end_ = count < kSlots - slot ? slot + count : kSlots;
    if (!t.context->arrays.anyInMemory(array, first_, end_)) return;
    context_ = t.context;
    stashError(*context_, driverError()); // keeps an error that the program has not queried yet
}

ArrayWatch::~ArrayWatch() {
    if (!context_) return;
    const GLenum error = driverError();
    stashError(*context_, error);
    if (error == GL_NO_ERROR) context_->arrays.moveToBuffer(array_, first_, end_);
}

} // namespace mural

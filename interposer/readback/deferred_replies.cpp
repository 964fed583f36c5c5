#include "interposer/readback/deferred_replies.hpp"

#include <cstdlib>
#include <new>

#include "interposer/context/lock.hpp"

namespace mural::deferred {

namespace {

Lock tableLock;
DeferredReply* first = nullptr; // oldest first
DeferredReply** last = &first;
int inFlight = 0;
uint64_t inFlightBytes = 0;

DeferredReply* find(uint32_t request) {
    for (DeferredReply* a = first; a; a = a->next)
        if (a->request == request) return a;
    return nullptr;
}

void unlinkAndFree(DeferredReply* answer) {
    for (DeferredReply** p = &first; *p; p = &(*p)->next) {
        if (*p != answer) continue;
        *p = answer->next;
        if (last == &answer->next) last = p;
        break;
    }
    std::free(answer->bytes);
    std::free(answer);
}

} // namespace

DeferredReply* add(uint32_t request, uint64_t sizeBytes) {
    void* const memory = std::malloc(sizeof(DeferredReply));
    void* const bytes = memory ? std::malloc(sizeBytes) : nullptr;
    if (!bytes) {
        std::free(memory);
        return nullptr;
    }
    auto* const answer = new (memory) DeferredReply{request, sizeBytes, static_cast<std::byte*>(bytes)};
    Guard guard(tableLock);
    *last = answer;
    last = &answer->next;
    ++inFlight;
    inFlightBytes += sizeBytes;
    return answer;
}

uint32_t conflictingWith(uint64_t sizeBytes) {
    Guard guard(tableLock);
    if (inFlight < kMaxDeferred && inFlightBytes + sizeBytes <= kMaxDeferredReplyBytes) return 0;
    for (const DeferredReply* a = first; a; a = a->next)
        if (a->state == DeferredReply::State::Requested) return a->request;
    return 0;
}

bool isAwaited(uint32_t request) {
    Guard guard(tableLock);
    const DeferredReply* const answer = find(request);
    return answer && answer->state == DeferredReply::State::Requested;
}

void release(DeferredReply* answer) {
    Guard guard(tableLock);
    answer->forgotten = true;
    if (answer->state != DeferredReply::State::Requested) return unlinkAndFree(answer);
    if (answer->coming) return; // another thread writes into its memory
    std::free(answer->bytes);
    answer->bytes = nullptr;
}

void forgetAll() {
    Guard guard(tableLock);
    first = nullptr; // release() frees entries that are still referenced
    last = &first;
    inFlight = 0;
    inFlightBytes = 0;
}

void* placeOf(uint32_t request, uint64_t sizeBytes, bool failed) {
    Guard guard(tableLock);
    DeferredReply* const answer = find(request);
    if (!answer || failed || sizeBytes != answer->sizeBytes) return nullptr;
    answer->coming = answer->bytes != nullptr;
    return answer->bytes;
}

void arrived(uint32_t request, bool whole) {
    Guard guard(tableLock);
    DeferredReply* const answer = find(request);
    if (!answer) return;
    answer->coming = false;
    answer->state = whole ? DeferredReply::State::Arrived : DeferredReply::State::None;
    --inFlight;
    inFlightBytes -= answer->sizeBytes;
    if (answer->forgotten) unlinkAndFree(answer);
}

} // namespace mural::deferred

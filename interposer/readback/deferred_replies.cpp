#include "interposer/readback/deferred_replies.hpp"

#include <cstdlib>
#include <new>

#include "interposer/context/lock.hpp"

namespace mural::owed {

namespace {

Lock tableLock;
OwedAnswer* first = nullptr; // oldest first
OwedAnswer** last = &first;
int onTheirWay = 0;
uint64_t onTheirWayBytes = 0;

OwedAnswer* find(uint32_t request) {
    for (OwedAnswer* a = first; a; a = a->next)
        if (a->request == request) return a;
    return nullptr;
}

void unlinkAndFree(OwedAnswer* answer) {
    for (OwedAnswer** p = &first; *p; p = &(*p)->next) {
        if (*p != answer) continue;
        *p = answer->next;
        if (last == &answer->next) last = p;
        break;
    }
    std::free(answer->bytes);
    std::free(answer);
}

} // namespace

OwedAnswer* add(uint32_t request, uint64_t sizeBytes) {
    void* const place = std::malloc(sizeof(OwedAnswer));
    void* const bytes = place ? std::malloc(sizeBytes) : nullptr;
    if (!bytes) {
        std::free(place);
        return nullptr;
    }
    auto* const answer = new (place) OwedAnswer{request, sizeBytes, static_cast<std::byte*>(bytes)};
    Guard guard(tableLock);
    *last = answer;
    last = &answer->next;
    ++onTheirWay;
    onTheirWayBytes += sizeBytes;
    return answer;
}

uint32_t inTheWayOf(uint64_t sizeBytes) {
    Guard guard(tableLock);
    if (onTheirWay < kMaxOwed && onTheirWayBytes + sizeBytes <= kMaxOwedBytes) return 0;
    for (const OwedAnswer* a = first; a; a = a->next)
        if (a->state == OwedAnswer::State::Asked) return a->request;
    return 0;
}

bool isAwaited(uint32_t request) {
    Guard guard(tableLock);
    const OwedAnswer* const answer = find(request);
    return answer && answer->state == OwedAnswer::State::Asked;
}

void release(OwedAnswer* answer) {
    Guard guard(tableLock);
    answer->forgotten = true;
    if (answer->state != OwedAnswer::State::Asked) return unlinkAndFree(answer);
    if (answer->coming) return; // another thread writes into its memory
    std::free(answer->bytes);
    answer->bytes = nullptr;
}

void forgetAll() {
    Guard guard(tableLock);
    first = nullptr; // release() frees entries that are still referenced
    last = &first;
    onTheirWay = 0;
    onTheirWayBytes = 0;
}

void* placeOf(uint32_t request, uint64_t sizeBytes, bool failed) {
    Guard guard(tableLock);
    OwedAnswer* const answer = find(request);
    if (!answer || failed || sizeBytes != answer->sizeBytes) return nullptr;
    answer->coming = answer->bytes != nullptr;
    return answer->bytes;
}

void arrived(uint32_t request, bool whole) {
    Guard guard(tableLock);
    OwedAnswer* const answer = find(request);
    if (!answer) return;
    answer->coming = false;
    answer->state = whole ? OwedAnswer::State::Here : OwedAnswer::State::None;
    --onTheirWay;
    onTheirWayBytes -= answer->sizeBytes;
    if (answer->forgotten) unlinkAndFree(answer);
}

} // namespace mural::owed

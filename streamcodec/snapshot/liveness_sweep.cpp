#include "streamcodec/snapshot/liveness_sweep.hpp"

#include <algorithm>

namespace mural::snapshot {

// Unmarked keys are live: the final state includes them.
bool LivenessSweep::needed(Key key) const {
    uint64_t last = 0;
    for (Key k = key;; k = keys_.parent(k)) {
        last = std::max(last, marks_[k].marked);
        if (k == kNoKey) break;
    }
    return (last & 1) == 0;
}

bool LivenessSweep::anyNeeded(Key key) const {
    uint64_t last = 0;
    for (Key k = key;; k = keys_.parent(k)) {
        last = std::max(last, marks_[k].marked);
        if (k == kNoKey) break;
    }
    return (last & 1) == 0 || marks_[key].readBelow > last;
}

void LivenessSweep::need(Key key) {
    const uint64_t now = ++step_ << 1;
    marks_[key].marked = now;
    for (Key k = key; k != kNoKey;) {
        k = keys_.parent(k);
        marks_[k].readBelow = now;
    }
}

// A live command references `key`, so the command that closes the key (or an ancestor) is live too.
void LivenessSweep::mention(Key key) {
    for (Key k = key; k != kNoKey; k = keys_.parent(k)) {
        if (marks_[k].closer == kNobody) continue;
        keepsAfterAll(marks_[k].closer);
        marks_[k].closer = kNobody;
    }
}

void LivenessSweep::open(Key key) {
    const auto found = restored_.find(key);
    const Key state = keys_.parent(keys_.parent(key)); // of all contexts and their objects
    if (found == restored_.end()) return need(state);  // the values that its end restores are not known yet
    for (const auto& [restored, wasNeeded] : found->second.keys)
        if (wasNeeded) need(restored);
    if (found->second.all) need(state);
    restored_.erase(found);
}

bool LivenessSweep::command(uint32_t number, std::span<const EffectEntry> effect, bool always) {
    bool stays = always, closes = false;
    for (const EffectEntry& e : effect) {
        stays = stays || ((e.mode == Mode::Write || e.mode == Mode::Kill) && anyNeeded(e.key));
        closes = closes || e.mode == Mode::Close;
    }
    Key level = kNoKey; // attribute stack level that this command closes
    for (const EffectEntry& e : effect)
        if (e.mode == Mode::Close) level = e.key;
    if (stays && level != kNoKey) restored_[level].all = true;
    // A closing command may become live later, so its reads count now. Effects are in execution order, so the sweep
    // visits them backwards: kills before reads.
    for (size_t i = effect.size(); i-- > 0;) {
        const EffectEntry& e = effect[i];
        if (stays) mention(e.key);
        switch (e.mode) {
        case Mode::Write:
        case Mode::Close: break;
        case Mode::Read:
            if (stays || closes) need(e.key);
            break;
        case Mode::Open: open(e.key); break;
        case Mode::Restore: restored_[level].keys.emplace_back(e.key, anyNeeded(e.key)); [[fallthrough]];
        case Mode::Kill:
        case Mode::Forget:
            marks_[e.key].marked = (++step_ << 1) | 1;
            if (e.mode == Mode::Kill) marks_[e.key].closer = kNobody; // the closed object does not exist
        }
    }
    for (const EffectEntry& e : effect)
        if (e.mode == Mode::Close && !stays) marks_[e.key].closer = number;
    if (stays && level != kNoKey) need(level);
    return stays;
}

} // namespace mural::snapshot

#include "tools/mural/child_runs/interruption.hpp"

namespace mural::cli {

namespace {

volatile std::sig_atomic_t received = 0;

void note(int number) {
    if (received == 0) received = number;
}

} // namespace

Interruption::Interruption() {
    received = 0;
    struct sigaction noted {};
    noted.sa_handler = note; // without SA_RESTART, so waits end
    for (size_t i = 0; i < kSignals.size(); ++i) {
        sigaction(kSignals[i], nullptr, &before_[i]);
        // an ignored signal stays ignored, as under nohup
        if (before_[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &noted, nullptr);
    }
}

Interruption::~Interruption() {
    for (size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

int Interruption::signal() { return received; }

} // namespace mural::cli

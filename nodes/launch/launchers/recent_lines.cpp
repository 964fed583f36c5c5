#include "nodes/launch/launchers/recent_lines.hpp"

namespace mural::launch {

void RecentLines::add(std::string_view line) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    if (line.empty()) return;
    std::string printable(line.substr(0, kBytes));
    for (char& c : printable)
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
    const std::lock_guard lock(mutex_);
    lines_.push_back(std::move(printable));
    if (lines_.size() > kLines) lines_.pop_front();
}

std::string RecentLines::text() const {
    const std::lock_guard lock(mutex_);
    std::string all;
    for (const std::string& line : lines_) all += (all.empty() ? "" : " | ") + line;
    return all;
}

} // namespace mural::launch

// A head without nodes: follows docs/reference/control-protocol.md as its first argument selects, to test `mural run`
// alone.
//   fake_head ok|error|frames|die|mute --control-fd N
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <unistd.h>

namespace {

int control = -1;

void sendLine(const std::string& line) {
    const std::string bytes = line + "\n";
    if (write(control, bytes.data(), bytes.size()) < 0) _exit(3);
}

// One line, or nothing after the end of the connection.
std::string readLine() {
    std::string line;
    char c = 0;
    while (read(control, &c, 1) == 1) {
        if (c == '\n') return line;
        line += c;
    }
    return {};
}

} // namespace

int main(int count, char** arguments) {
    if (count != 4 || std::strcmp(arguments[2], "--control-fd") != 0) return 2;
    const std::string mode = arguments[1];
    control = std::atoi(arguments[3]);
    const std::string config = readLine();
    if (config.find("\"session\"") == std::string::npos) return 2;
    if (mode == "mute") return 0;
    if (mode == "error") {
        sendLine(R"({"event":"error","text":"no GL on this machine"})");
        return 1;
    }
    sendLine(R"({"event":"ready","explain":[]})");
    if (mode == "die") raise(SIGKILL);
    if (mode == "frames") sendLine(R"({"event":"frames-reached"})");
    if (readLine() != R"({"command":"finish"})") return 4;
    sendLine(R"({"event":"report","frames":3,"seconds":1,"framesPerSecond":3})");
    return 0;
}

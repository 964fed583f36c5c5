#include "tools/mural/page/hub/head_link.hpp"

#include <string_view>

#include <boost/asio/write.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "common/ipc/user_socket.hpp"
#include "common/json/json_text.hpp"
#include "nodes/head/control/control_operations.hpp"

namespace mural::page {

namespace {

using Json = nlohmann::json;
using boost::system::error_code;

constexpr size_t kMaxHeadLineBytes = size_t{16} << 20;

} // namespace

Result<std::shared_ptr<HeadLink>> HeadLink::connect(boost::asio::io_context& io, const std::string& path) {
    Socket socket(io);
    error_code error;
    socket.connect(boost::asio::local::stream_protocol::endpoint(path), error);
    if (error) return Error{"no connection to the session at " + path + ": " + error.message()};
    if (!isPeerOwn(socket.native_handle()))
        return Error{"no connection to the session at " + path + ": it belongs to another user"};
    return std::shared_ptr<HeadLink>(new HeadLink(std::move(socket)));
}

void HeadLink::begin(OnMessage onMessage, OnLost onLost) {
    onMessage_ = std::move(onMessage);
    onLost_ = std::move(onLost);
    receive();
}

void HeadLink::request(const std::string& operation, const Json& arguments, OnReply onReply) {
    const int64_t id = ++lastId_;
    waiting_[id] = std::move(onReply);
    unsent_.push_back(jsonText({{"id", id}, {"op", operation}, {"args", arguments}}) + "\n");
    if (isLost_) return lose();
    if (unsent_.size() == 1) send();
}

void HeadLink::send() {
    boost::asio::async_write(socket_, boost::asio::buffer(unsent_.front()),
                             [self = shared_from_this()](const error_code& error, size_t) {
                                 if (error) return self->lose();
                                 self->unsent_.pop_front();
                                 if (!self->unsent_.empty()) self->send();
                             });
}

void HeadLink::receive() {
    socket_.async_read_some(boost::asio::buffer(part_),
                            [self = shared_from_this()](const error_code& error, size_t bytes) {
                                self->received_.append(self->part_.data(), bytes);
                                self->take();
                                if (error || self->received_.size() > kMaxHeadLineBytes) return self->lose();
                                self->receive();
                            });
}

void HeadLink::take() {
    size_t at = 0;
    for (size_t end = 0; (end = received_.find('\n', at)) != std::string::npos; at = end + 1)
        takeLine(std::string_view(received_).substr(at, end - at));
    received_.erase(0, at);
}

void HeadLink::takeLine(std::string_view line) {
    Json message = parseJson(line);
    if (!message.is_object() || message.contains("hello")) return;
    if (message.contains("topic")) {
        if (onMessage_) onMessage_(std::move(message));
        return;
    }
    const auto id = message.find("id");
    if (id == message.end() || !id->is_number_integer()) return; // such as: too many clients
    const auto found = waiting_.find(id->get<int64_t>());
    if (found == waiting_.end()) return;
    const OnReply onReply = std::move(found->second);
    waiting_.erase(found);
    message.erase("id");
    onReply(std::move(message));
}

void HeadLink::lose() {
    isLost_ = true;
    error_code ignored;
    socket_.close(ignored);
    for (auto& [id, onReply] : std::exchange(waiting_, {}))
        onReply({{"ok", false}, {"code", control_code::kFailed}, {"error", "the session has ended"}});
    if (const OnLost onLost = std::exchange(onLost_, nullptr)) onLost();
}

void HeadLink::close() {
    onLost_ = nullptr;
    onMessage_ = nullptr;
    waiting_.clear();
    error_code ignored;
    socket_.close(ignored);
    isLost_ = true;
}

} // namespace mural::page

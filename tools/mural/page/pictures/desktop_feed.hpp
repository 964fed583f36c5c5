// Pictures of the program's private display, with its dialogs and menus. A thread of its own asks the X server while a
// wish waits.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include <boost/asio/io_context.hpp>

#include "nodes/input/program_display.hpp"
#include "tools/mural/page/pictures/picture_source.hpp"

namespace mural::page {

class DesktopEye;

class DesktopFeed : public PictureSource, public std::enable_shared_from_this<DesktopFeed> {
public:
    static std::shared_ptr<DesktopFeed> create(boost::asio::io_context& io);
    DesktopFeed(const DesktopFeed&) = delete;
    DesktopFeed& operator=(const DesktopFeed&) = delete;
    ~DesktopFeed() override;

    // nullopt: not known yet; wishes wait.
    void use(std::optional<input::ProgramDisplay> display);
    void wish(const PictureWish& wish, OnPicture onPicture) override;
    [[nodiscard]] bool isWaiting() const override { return onPicture_ != nullptr; }
    void close() override;

private:
    explicit DesktopFeed(boost::asio::io_context& io) : io_(io) {}
    void work();
    void take(FeedPicture picture);

    boost::asio::io_context& io_;
    OnPicture onPicture_;
    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::optional<input::ProgramDisplay> display_;
    std::optional<PictureWish> wish_;
    int openFd_ = -1; // of the connection; -1: none
    bool stop_ = false;
    std::thread thread_;
};

} // namespace mural::page

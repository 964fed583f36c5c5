// All objects that a process writes: makes Shared<T>, and connects them with an ObjectMaster.
#pragma once

#include <memory>

#include <mural/shared.hpp>

#include "objects/core/object_master.hpp"

namespace mural::objects {

// Thread safety: any thread. The sink is called with a lock held, by the threads that commit and by those that call
// input() and tick(). It must not call back.
class ObjectWriter {
public:
    // `sink` must live until close().
    explicit ObjectWriter(MessageSink& sink, const MasterOptions& options = {});
    ~ObjectWriter();
    ObjectWriter(const ObjectWriter&) = delete;
    ObjectWriter& operator=(const ObjectWriter&) = delete;

    // Shares an object. Readers see its value after its first commit. The result may outlive the writer.
    // Errors: the name is too long, too many objects, the writer is closed.
    template <class T> Result<Shared<T>> share(T value, const ShareOptions& options = {}) {
        auto object = shareAny(archive::layoutOf<T>(), options);
        if (!object) return object.error();
        return Shared<T>(std::move(object.value()), std::move(value));
    }
    Result<std::unique_ptr<SharedObject>> shareAny(const archive::TypeLayout& layout, const ShareOptions& options);

    // ObjectMaster has the descriptions.
    void join(PeerId reader, const std::string& name);
    void leave(PeerId reader);
    Result<void> input(PeerId reader, std::span<const std::byte> message, int64_t nowNs);
    void tick(int64_t nowNs);
    void frame(uint64_t number);
    void frameDone(uint64_t number);

    // Ends all objects without a message. Later commits fail, and waiting ones return.
    void close();

    struct Core;

private:
    std::shared_ptr<Core> core_;
};

} // namespace mural::objects

// The declarations follow the PMIx standard 4.1 (chapters 3, 5 and 6); they are the same in the libraries 2 to 5.
#include "nodes/launch/launchers/pmix_client.hpp"

#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <future>
#include <poll.h>
#include <thread>

namespace mural::launch {
namespace {

constexpr int kPmixSuccess = 0;
constexpr uint8_t kScopeGlobal = 3;
constexpr uint16_t kTypeString = 3;
constexpr size_t kMaxNamespace = 255, kMaxKey = 511;

struct Process {
    char nspace[kMaxNamespace + 1];
    uint32_t rank;
};

// The union of a value has at most 24 bytes in the libraries so far.
struct Value {
    uint16_t type;
    union {
        char* string;
        std::array<char, 56> bytes;
    };
};

int numberIn(const Environment& environment, const char* name, int otherwise) {
    const std::string text = environment.get(name).value_or("");
    int number = otherwise;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? number : otherwise;
}

} // namespace

struct PmixClient::Library {
    void* handle = nullptr; // stays open: the library has threads
    Process self{};
    int (*init)(Process*, void*, size_t) = nullptr;
    int (*finalize)(const void*, size_t) = nullptr;
    int (*put)(uint8_t, const char*, Value*) = nullptr;
    int (*commit)() = nullptr;
    int (*fence)(const Process*, size_t, const void*, size_t) = nullptr;
    int (*get)(const Process*, const char*, const void*, size_t, Value**) = nullptr;
    const char* (*errorText)(int) = nullptr;

    template <class Function> bool find(Function& function, const char* name) const {
        function = reinterpret_cast<Function>(dlsym(handle, name));
        return function != nullptr;
    }
    bool findAll() {
        return find(init, "PMIx_Init") && find(finalize, "PMIx_Finalize") && find(put, "PMIx_Put") &&
               find(commit, "PMIx_Commit") && find(fence, "PMIx_Fence") && find(get, "PMIx_Get") &&
               find(errorText, "PMIx_Error_string");
    }
    [[nodiscard]] Result<void> check(const char* call, int code) const {
        if (code == kPmixSuccess) return {};
        return Error{std::string(call) + ": " + errorText(code)};
    }
};

PmixPlace pmixPlaceOf(const Environment& environment) {
    PmixPlace place;
    place.rank = numberIn(environment, "PMIX_RANK", -1);
    for (const char* const name : {"OMPI_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS", "SLURM_NTASKS", "PMI_SIZE"})
        if (place.size == 0) place.size = numberIn(environment, name, 0);
    return place;
}

PmixClient::PmixClient(std::shared_ptr<Library> library) : library_(std::move(library)) {}

Result<std::unique_ptr<PmixClient>> PmixClient::open() {
    auto library = std::make_shared<Library>();
    library->handle = dlopen("libpmix.so.2", RTLD_NOW | RTLD_LOCAL);
    if (library->handle == nullptr) return Error{"libpmix.so.2 is not installed"};
    if (!library->findAll()) return Error{"libpmix.so.2 lacks a function of PMIx"};
    if (auto begun = library->check("PMIx_Init", library->init(&library->self, nullptr, 0)); !begun)
        return begun.error();
    return std::unique_ptr<PmixClient>(new PmixClient(std::move(library)));
}

PmixClient::~PmixClient() {
    if (!isInFence_) library_->finalize(nullptr, 0);
}

Result<void> PmixClient::put(const std::string& key, const std::string& text) const {
    if (key.size() > kMaxKey) return Error{"PMIx_Put: the key is too long"};
    Value value{};
    value.type = kTypeString;
    value.string = const_cast<char*>(text.c_str()); // it is copied
    if (auto done = library_->check("PMIx_Put", library_->put(kScopeGlobal, key.c_str(), &value)); !done) return done;
    return library_->check("PMIx_Commit", library_->commit());
}

Result<void> PmixClient::fence(Deadline deadline, const std::function<bool()>& cancelled) const {
    auto promise = std::make_shared<std::promise<int>>();
    auto done = promise->get_future();
    std::thread([library = library_, promise] { promise->set_value(library->fence(nullptr, 0, nullptr, 0)); }).detach();
    while (done.wait_for(std::chrono::milliseconds(10)) != std::future_status::ready) {
        const bool isCancelled = cancelled && cancelled();
        if (!isCancelled && !deadline.passed()) continue;
        isInFence_ = true;
        if (isCancelled) return Error{"the wait for the other processes of the start was interrupted"};
        return Error{"not all processes of the start have arrived; each must run the same mural run"};
    }
    return library_->check("PMIx_Fence", done.get());
}

Result<std::string> PmixClient::get(uint32_t rank, const std::string& key) const {
    Process from = library_->self;
    from.rank = rank;
    Value* value = nullptr;
    if (auto done = library_->check("PMIx_Get", library_->get(&from, key.c_str(), nullptr, 0, &value)); !done)
        return done.error();
    std::string text = value->type == kTypeString && value->string != nullptr ? value->string : "";
    if (value->type == kTypeString) std::free(value->string);
    std::free(value);
    return text;
}

} // namespace mural::launch

// The declarations follow munge.h of MUNGE 0.5.15 (man 3 munge).
#include "nodes/launch/launchers/starter/munge_seal.hpp"

#include <cstdlib>
#include <dlfcn.h>
#include <sys/types.h>
#include <unistd.h>

namespace mural::launch {
namespace {

constexpr int kMungeSuccess = 0;
constexpr int kUidRestriction = 9; // MUNGE_OPT_UID_RESTRICTION

} // namespace

struct MungeSeal::Library {
    using Context = void*;
    void* handle = nullptr;
    int (*encode)(char** credential, Context, const void* bytes, int size) = nullptr;
    int (*decode)(const char* credential, Context, void** bytes, int* size, uid_t*, gid_t*) = nullptr;
    const char* (*errorText)(int) = nullptr;
    Context (*createContext)() = nullptr;
    void (*destroyContext)(Context) = nullptr;
    int (*setOption)(Context, int option, ...) = nullptr;

    template <class Function> bool find(Function& function, const char* name) const {
        function = reinterpret_cast<Function>(dlsym(handle, name));
        return function != nullptr;
    }
    bool findAll() {
        return find(encode, "munge_encode") && find(decode, "munge_decode") && find(errorText, "munge_strerror") &&
               find(createContext, "munge_ctx_create") && find(destroyContext, "munge_ctx_destroy") &&
               find(setOption, "munge_ctx_set");
    }
    [[nodiscard]] Error failed(const char* what, int code) const {
        return Error{std::string("MUNGE cannot ") + what + " it: " + errorText(code) + "; check munged with munge -n"};
    }
    ~Library() {
        if (handle != nullptr) dlclose(handle);
    }
};

MungeSeal::MungeSeal(std::unique_ptr<Library> library) : library_(std::move(library)) {}
MungeSeal::~MungeSeal() = default;

Result<std::unique_ptr<MungeSeal>> MungeSeal::open() {
    auto library = std::make_unique<Library>();
    library->handle = dlopen("libmunge.so.2", RTLD_NOW | RTLD_LOCAL);
    if (library->handle == nullptr) return Error{"libmunge.so.2 is not installed"};
    if (!library->findAll()) return Error{"libmunge.so.2 lacks a function of MUNGE 0.5"};
    return std::unique_ptr<MungeSeal>(new MungeSeal(std::move(library)));
}

Result<std::string> MungeSeal::seal(const std::string& text) const {
    Library::Context context = library_->createContext();
    if (context == nullptr) return Error{"MUNGE has no memory"};
    char* credential = nullptr;
    int code = library_->setOption(context, kUidRestriction, geteuid());
    if (code == kMungeSuccess)
        code = library_->encode(&credential, context, text.data(), static_cast<int>(text.size()));
    library_->destroyContext(context);
    if (code != kMungeSuccess) return library_->failed("seal", code);
    std::string sealed = credential;
    std::free(credential);
    return sealed;
}

Result<std::string> MungeSeal::unseal(const std::string& credential) const {
    void* bytes = nullptr;
    int size = 0;
    uid_t user = 0;
    gid_t group = 0;
    const int code = library_->decode(credential.c_str(), nullptr, &bytes, &size, &user, &group);
    std::string text(static_cast<const char*>(bytes), bytes != nullptr ? static_cast<size_t>(size) : 0);
    std::free(bytes);
    if (code != kMungeSuccess) return library_->failed("unseal", code); // also a second use: the text is not trusted
    if (user != geteuid()) return Error{"the credential is of user " + std::to_string(user)};
    return text;
}

} // namespace mural::launch

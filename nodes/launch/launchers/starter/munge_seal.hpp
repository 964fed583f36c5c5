// Seals text with MUNGE, the authentication service of Slurm clusters, for processes of the same user on hosts with the
// same MUNGE key. The library is opened at run time, because machines without Slurm do not have it.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.hpp"

namespace mural::launch {

class MungeSeal {
public:
    // Errors: libmunge.so.2 is not installed.
    static Result<std::unique_ptr<MungeSeal>> open();
    MungeSeal(const MungeSeal&) = delete;
    MungeSeal& operator=(const MungeSeal&) = delete;
    ~MungeSeal();

    // Returns a word without spaces. Errors: munged does not run.
    [[nodiscard]] Result<std::string> seal(const std::string& text) const;
    // A host unseals a credential once. Errors: another user, key or cluster; an old or changed credential.
    [[nodiscard]] Result<std::string> unseal(const std::string& credential) const;

private:
    struct Library;
    explicit MungeSeal(std::unique_ptr<Library> library);
    const std::unique_ptr<Library> library_;
};

} // namespace mural::launch

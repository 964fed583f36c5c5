// Options of `mural run` for the files that the session writes.
#include <algorithm>
#include <fmt/format.h>
#include <set>

#include "nodes/remote_wall/wall_target.hpp"
#include "tools/mural/run/option_values.hpp"
#include "tools/mural/run/run_option_readers.hpp"
#include "transport/rsp/group_text.hpp"

namespace mural::cli {

namespace {

// Checks the remote walls and their secrets.
Result<void> readSends(const RunArguments& a, SessionConfig& c) {
    std::set<std::string> names;
    for (const std::string& text : a.sends) {
        const auto target = remote::wallTargetOf(text);
        if (!target) return target.error();
        if (!names.insert(target->name).second)
            return badValue("--send", text, "must have another name; --send " + target->name + " was given before");
        const std::string& secret = target->secretFile.empty() ? c.launchSecret : target->secretFile;
        if (secret.empty())
            return Error{"--send " + text + ": add --secret FILE with the secret of mural show, or secret=FILE"};
        if (auto read = rsp::readSecret(secret); !read)
            return Error{"--send " + target->name + ": " + read.error().message};
    }
    c.sends = a.sends;
    return {};
}

} // namespace

Result<void> readOutput(const RunArguments& a, SessionConfig& c) {
    if (a.out && a.out->empty()) return badValue("--out", "", "must be a folder or a video file, such as --out shots");
    c.out = a.out.value_or("");
    if (a.record && a.record->empty()) return badValue("--record", "", "must be a file, such as --record app.mural");
    c.record = a.record.value_or("");
    if (a.frameTimes && a.frameTimes->empty())
        return badValue("--frame-times", "", "must be a file, such as --frame-times times.jsonl");
    c.frameTimes = a.frameTimes.value_or("");
    if (auto read = readSends(a, c); !read) return read;
    if (a.overlayInFiles && !a.out)
        return Error{"--overlay-in-files requires --out; add a destination, such as --out shots"};
    if (a.overlayInFiles && c.passes.stereo == StereoMode::Quad)
        return Error{
            "--overlay-in-files draws over pictures of one eye, but --stereo quad saves both; omit one of them"};
    c.overlayInFiles = a.overlayInFiles;
    if (!a.save) return {};
    if (!a.out) return Error{"--save requires --out; add a destination, such as --out shots"};
    for (const std::string& part : listOf(*a.save)) {
        const auto frame = wholeNumber(part, 1, INT64_MAX);
        if (!frame)
            return badValue("--save", *a.save,
                            "must be frame numbers, at least 1, separated by commas, such as 1,30,90");
        c.saveFrames.push_back(*frame);
    }
    std::sort(c.saveFrames.begin(), c.saveFrames.end());
    c.saveFrames.erase(std::unique(c.saveFrames.begin(), c.saveFrames.end()), c.saveFrames.end());
    if (c.frames > 0 && c.saveFrames.back() > c.frames)
        return badValue("--save", *a.save,
                        fmt::format("must have no frame after the last one, {} (--frames)", c.frames));
    return {};
}

} // namespace mural::cli

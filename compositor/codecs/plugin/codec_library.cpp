#include "compositor/codecs/plugin/codec_library.hpp"

#include <dlfcn.h>
#include <filesystem>
#include <system_error>

namespace mural::compositor {

namespace {

// Requires equal versions: newer tables only grow, but the meaning of a function may have changed.
std::string whyUnfit(const mural_codec_plugin* plugin, const std::string& name) {
    if (!plugin) return "its " MURAL_CODEC_PLUGIN_ENTRY "() returns no table";
    if (plugin->version != MURAL_CODEC_PLUGIN_VERSION)
        return "it implements version " + std::to_string(plugin->version) +
               " of the plug-in interface, but this Mural has version " + std::to_string(MURAL_CODEC_PLUGIN_VERSION);
    if (plugin->size_bytes < sizeof *plugin) return "its table is truncated";
    if (!plugin->name || name != plugin->name)
        return std::string("it implements the codec \"") + (plugin->name ? plugin->name : "") + "\"";
    if (!plugin->create || !plugin->destroy || !plugin->bound_bytes || !plugin->encode || !plugin->decode)
        return "a function of its table is missing";
    return {};
}

mural_codec_shape shapeFor(const PlaneShape& s) { return {static_cast<uint32_t>(s.format), s.width, s.height}; }

std::string textOf(const mural_codec_error& error) {
    const std::string_view text(error.text, sizeof error.text);
    return std::string(text.substr(0, text.find('\0')));
}

class PluginCodec : public Codec {
public:
    PluginCodec(const mural_codec_plugin& plugin, mural_codec* codec) : plugin_(plugin), codec_(codec) {}
    ~PluginCodec() override { plugin_.destroy(codec_); }
    PluginCodec(const PluginCodec&) = delete;
    PluginCodec& operator=(const PluginCodec&) = delete;

    [[nodiscard]] size_t boundBytes(const PlaneShape& shape) const override {
        const mural_codec_shape s = shapeFor(shape);
        return static_cast<size_t>(plugin_.bound_bytes(codec_, &s));
    }
    [[nodiscard]] Result<size_t> encode(const PlaneView& plane, std::span<std::byte> into) override {
        // The plug-in only reads the pixels; one struct serves both directions.
        const mural_codec_plane p{shapeFor(shapeOf(plane)), plane.strideBytes, const_cast<std::byte*>(plane.pixels)};
        mural_codec_error error{};
        uint64_t written = 0;
        if (!plugin_.encode(codec_, &p, into.data(), into.size(), &written, &error)) return Error{textOf(error)};
        if (written > into.size())
            return Error{std::string("codec ") + plugin_.name +
                         ": it wrote more bytes than its bound; the plug-in is faulty, use another codec"};
        return static_cast<size_t>(written);
    }
    [[nodiscard]] Result<void> decode(std::span<const std::byte> bytes, const MutablePlaneView& into) override {
        const mural_codec_plane p{shapeFor(shapeOf(into)), into.strideBytes, into.pixels};
        mural_codec_error error{};
        if (!plugin_.decode(codec_, bytes.data(), bytes.size(), &p, &error)) return Error{textOf(error)};
        return {};
    }

private:
    const mural_codec_plugin& plugin_;
    mural_codec* codec_;
};

} // namespace

Result<const mural_codec_plugin*> openCodecPlugin(const std::string& name, const std::string& folder) {
    const std::string file = (std::filesystem::path(folder) / ("libmural_codec_" + name + ".so")).string();
    const std::string what = "codec " + name + ": ";
    std::error_code failed;
    if (!std::filesystem::exists(file, failed))
        return Error{what + "the plug-in is missing: " + file + "; check the name, or build or install the plug-in"};
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!library) {
        const char* message = dlerror(); // contains the file name
        return Error{what + "cannot load the plug-in: " + (message ? message : file) + "; install its dependencies"};
    }
    const auto entry = reinterpret_cast<mural_codec_plugin_entry>(dlsym(library, MURAL_CODEC_PLUGIN_ENTRY));
    const mural_codec_plugin* plugin = entry ? entry() : nullptr;
    const std::string unfit = entry ? whyUnfit(plugin, name) : "it has no function " MURAL_CODEC_PLUGIN_ENTRY;
    if (!unfit.empty())
        return Error{what + file + " is not a suitable plug-in: " + unfit +
                     "; build it with this Mural's codec_plugin.h"};
    return plugin;
}

CodecInfo infoOf(const mural_codec_plugin& plugin) {
    return {plugin.name, plugin.lossless != 0, plugin.formats & kAllFormats};
}

Result<std::unique_ptr<Codec>> makeCodec(const mural_codec_plugin& plugin) {
    mural_codec_error error{};
    mural_codec* codec = plugin.create(&error);
    if (!codec) return Error{textOf(error)};
    return std::unique_ptr<Codec>(std::make_unique<PluginCodec>(plugin, codec));
}

} // namespace mural::compositor

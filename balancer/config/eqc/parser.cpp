#include "balancer/config/eqc/parser.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "balancer/config/global_attributes.hpp"
#include "balancer/config/eqc/section_reader.hpp"

namespace mural::config {

namespace {

constexpr size_t kMaxBytes = size_t{16} << 20; // the largest known file has 31 KB

class Parser {
public:
    Parser(const TokenList& list, Diagnostics& diagnostics) : tokens_(list.tokens, diagnostics), sections_(tokens_) {
        file_.version = list.version;
        file_.heading = list.heading;
        if (list.version > kCurrentVersion)
            diagnostics.warn({1, 1}, "the file has a later version of the format than 1.2",
                             "check the fields that are reported as unknown");
    }

    ConfigFile run() {
        while (!tokens_.ended()) readTop();
        if (!haveConfig_ && !tokens_.failed())
            tokens_.fail(tokens_.peek().at, "the file contains no configuration", "it begins with: server { config {");
        return std::move(file_);
    }

private:
    // file = [ global ] ( server | config )
    void readTop() {
        const Token& token = tokens_.take();
        if (token.kind != TokenKind::Word) {
            if (!haveConfig_)
                return tokens_.fail(token.at, shown(token) + " is outside of any section",
                                    "a file begins with global { or server {");
            return tokens_.warn(token.at, shown(token) + " after the configuration is ignored",
                                "check for a missing bracket before it, or remove it");
        }
        if (token.text == "global")
            readGlobals();
        else if (token.text == "server")
            readServer();
        else if (token.text == "config")
            readConfig(token);
        else if (token.text.starts_with("EQ_"))
            readGlobal(token);
        else
            skip(token, "the file");
    }

    // Reads "global { ... }", which may be nested, or a single attribute.
    void readGlobals() {
        if (!tokens_.accept('{')) return;
        for (int depth = 1; depth > 0 && !tokens_.failed();) {
            const Token& token = tokens_.take();
            if (token.is('}'))
                --depth;
            else if (token.is('{'))
                ++depth;
            else if (token.kind == TokenKind::Word && token.text != "global")
                readGlobal(token);
            else if (token.kind == TokenKind::End)
                return tokens_.fail(token.at, "section global ends with }, but the file ends here", "add it");
            else if (token.kind != TokenKind::Word)
                return tokens_.fail(token.at, shown(token) + " is not a global attribute", "remove it");
        }
    }

    void readGlobal(const Token& token) {
        const GlobalAttribute* attribute = findGlobalAttribute(token.text);
        if (attribute == nullptr) return skip(token, "global");
        if (attribute->name != token.text)
            tokens_.warn(token.at, std::string(token.text) + " was renamed to " + std::string(attribute->name),
                         "rename it");
        if (const auto value = readGlobalValue(tokens_, *attribute))
            file_.globals[std::string(attribute->name)] = *value;
    }

    void readServer() {
        if (!tokens_.expect('{', "server")) return;
        while (!tokens_.ended() && !tokens_.peek().is('}')) {
            const Token& token = tokens_.take();
            if (token.kind == TokenKind::Word && token.text == "connection") {
                sections_.readSection("connection", token.at, file_.serverConnections.emplace_back());
            } else if (token.kind == TokenKind::Word && token.text == "config") {
                readConfig(token);
            } else if (token.kind == TokenKind::Word) {
                skip(token, "server");
            } else {
                return tokens_.fail(token.at, shown(token) + " is not a field of section server",
                                    "remove it, or check for a missing bracket before it");
            }
        }
        tokens_.expect('}', "section server");
    }

    void readConfig(const Token& token) {
        if (!haveConfig_) {
            haveConfig_ = true;
            return sections_.readSection("config", token.at, file_.config);
        }
        tokens_.warn(token.at, "a second configuration is ignored", "move it to its own file");
        Config unused;
        sections_.readSection("config", token.at, unused);
    }

    void skip(const Token& token, const std::string& where) {
        tokens_.warn(token.at, "unknown field in " + where + ": " + std::string(token.text) + ", it is ignored",
                     "check its spelling, or remove it");
        tokens_.skipValue();
        // Skips a value that is a word, such as ON. Every word that begins a field is followed by a bracket or a value.
        if (tokens_.peek().kind == TokenKind::Word && isAttributeWord(tokens_.peek().text)) tokens_.take();
    }

    ConfigFile file_;
    TokenReader tokens_;
    SectionReader sections_;
    bool haveConfig_ = false;
};

} // namespace

ConfigFile parseConfig(std::string_view text, Diagnostics& diagnostics) {
    const TokenList list = tokenize(text, diagnostics);
    if (list.failed) return {};
    return Parser(list, diagnostics).run();
}

ConfigFile readConfigFile(const std::string& path, Diagnostics& diagnostics) {
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    std::string text;
    if (in) {
        text.assign(kMaxBytes + 1, '\0');
        in.read(text.data(), static_cast<std::streamsize>(text.size()));
        text.resize(static_cast<size_t>(in.gcount()));
    }
    if (!in.eof() && text.size() <= kMaxBytes) {
        diagnostics.error({}, std::string("cannot be read: ") + std::strerror(errno != 0 ? errno : EIO),
                          "check the name and its permissions");
        return {};
    }
    if (text.size() > kMaxBytes) {
        diagnostics.error({}, "is larger than 16 MiB", "choose a configuration file");
        return {};
    }
    return parseConfig(text, diagnostics);
}

} // namespace mural::config

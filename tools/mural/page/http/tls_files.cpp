#include "tools/mural/page/http/tls_files.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <memory>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

namespace mural::page {

namespace {

struct FreeOpenSsl {
    void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
    void operator()(X509* certificate) const { X509_free(certificate); }
    void operator()(X509_EXTENSION* extension) const { X509_EXTENSION_free(extension); }
};
struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using Key = std::unique_ptr<EVP_PKEY, FreeOpenSsl>;
using Certificate = std::unique_ptr<X509, FreeOpenSsl>;
using File = std::unique_ptr<std::FILE, CloseFile>;

constexpr long kValidSeconds = 10L * 365 * 24 * 3600;

Error noPair(const std::string& folder, const std::string& why) {
    return Error{"no key pair for TLS can be made in " + folder + ": " + why +
                 "; give files with --page-cert and --page-key"};
}

std::string stateFolder() {
    const char* state = std::getenv("XDG_STATE_HOME");
    if (state != nullptr && state[0] == '/') return std::string(state) + "/mural";
    const char* home = std::getenv("HOME");
    return std::string(home != nullptr ? home : "/nonexistent") + "/.local/state/mural";
}

// Only this user can read the file. An existing file of that name is replaced.
File createPrivate(const std::string& path) {
    unlink(path.c_str());
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
    return File(fd >= 0 ? fdopen(fd, "w") : nullptr);
}

bool describe(X509* certificate, EVP_PKEY* key) {
    unsigned char serial[8];
    if (RAND_bytes(serial, sizeof serial) != 1) return false;
    serial[0] &= 0x7f; // positive
    uint64_t number = 0;
    std::memcpy(&number, serial, sizeof number);
    char host[256] = {};
    gethostname(host, sizeof host - 1);
    X509_NAME* name = X509_get_subject_name(certificate);
    const std::string names = fmt::format("DNS:{},DNS:localhost,IP:127.0.0.1,IP:::1", host);
    const std::unique_ptr<X509_EXTENSION, FreeOpenSsl> extension(
        X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, names.c_str()));
    return X509_set_version(certificate, 2) == 1 &&
           ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate), number >> 1) == 1 &&
           X509_gmtime_adj(X509_getm_notBefore(certificate), 0) != nullptr &&
           X509_gmtime_adj(X509_getm_notAfter(certificate), kValidSeconds) != nullptr &&
           X509_set_pubkey(certificate, key) == 1 &&
           X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8, reinterpret_cast<const unsigned char*>("mural page"),
                                      -1, -1, 0) == 1 &&
           X509_set_issuer_name(certificate, name) == 1 && extension != nullptr &&
           X509_add_ext(certificate, extension.get(), -1) == 1 && X509_sign(certificate, key, EVP_sha256()) != 0;
}

Certificate readCertificate(const std::string& path) {
    const File file(std::fopen(path.c_str(), "re"));
    return Certificate(file ? PEM_read_X509(file.get(), nullptr, nullptr, nullptr) : nullptr);
}

bool isValidFor(const std::string& path, long seconds) {
    const Certificate certificate = readCertificate(path);
    time_t until = time(nullptr) + seconds;
    return certificate && X509_cmp_time(X509_get0_notAfter(certificate.get()), &until) > 0;
}

} // namespace

Result<TlsFiles> ownTlsFiles() {
    const std::string folder = stateFolder();
    const TlsFiles files{folder + "/page-certificate.pem", folder + "/page-key.pem"};
    constexpr long kWeek = 7 * 24 * 3600;
    if (access(files.key.c_str(), R_OK) == 0 && isValidFor(files.certificate, kWeek)) return files;
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed) return noPair(folder, failed.message());
    const Key key(EVP_EC_gen("P-256"));
    const Certificate certificate(X509_new());
    if (!key || !certificate || !describe(certificate.get(), key.get())) return noPair(folder, "OpenSSL failed");
    const File keyFile = createPrivate(files.key), certificateFile = createPrivate(files.certificate);
    if (!keyFile || !certificateFile) return noPair(folder, std::strerror(errno));
    if (PEM_write_PrivateKey(keyFile.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1 ||
        PEM_write_X509(certificateFile.get(), certificate.get()) != 1 || std::fflush(keyFile.get()) != 0 ||
        std::fflush(certificateFile.get()) != 0)
        return noPair(folder, "the files cannot be written");
    return files;
}

Result<std::string> fingerprintOf(const std::string& path) {
    const Certificate certificate = readCertificate(path);
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned size = 0;
    if (!certificate || X509_digest(certificate.get(), EVP_sha256(), digest, &size) != 1)
        return Error{path + " is no certificate in PEM format; choose another with --page-cert"};
    std::string text;
    for (unsigned i = 0; i < size; ++i) text += fmt::format("{}{:02X}", i == 0 ? "" : ":", digest[i]);
    return text;
}

} // namespace mural::page

#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <fstream>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "objects/blob/blob_assembly.hpp"
#include "objects/blob/blob_memory.hpp"
#include "objects/blob/blob_store.hpp"
#include "tests/temporary_folder.hpp"

namespace mural::test {
namespace {

using objects::BlobPlace;

constexpr size_t kLargeBytes = size_t{1} << 20;

std::vector<std::byte> pattern(size_t sizeBytes, unsigned seed = 1) {
    std::vector<std::byte> bytes(sizeBytes);
    for (std::byte& byte : bytes) {
        seed = seed * 1664525 + 1013904223;
        byte = static_cast<std::byte>(seed >> 24);
    }
    return bytes;
}

TEST(Blob, namesContentsAndSharesMemory) {
    for (const size_t sizeBytes : {size_t{0}, size_t{5}, kLargeBytes}) {
        const auto bytes = pattern(sizeBytes);
        const Blob copied = Blob::copyOf(bytes).value();
        const Blob filled =
            Blob::make(sizeBytes, [&](std::span<std::byte> into) { std::ranges::copy(bytes, into.begin()); }).value();
        EXPECT_TRUE(std::ranges::equal(copied.bytes(), bytes));
        EXPECT_TRUE(std::ranges::equal(filled.bytes(), bytes));
        EXPECT_EQ(copied, filled);
        const Blob copy = copied; // NOLINT(performance-unnecessary-copy-initialization)
        EXPECT_EQ(copy.bytes().data(), copied.bytes().data());
    }
    EXPECT_FALSE(Blob::copyOf(pattern(9)).value() == Blob::copyOf(pattern(9, 2)).value());
}

TEST(Blob, viewsWholeElements) {
    const Blob blob = Blob::copyOf(pattern(11)).value();
    EXPECT_EQ(blob.as<uint32_t>().size(), 2U);
    EXPECT_EQ(Blob().as<double>().size(), 0U);
}

TEST(Blob, mapsFiles) {
    const TemporaryFolder folder;
    const auto bytes = pattern(100'000);
    const std::string path = folder.at("data");
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), 100'000);
    const Blob blob = Blob::mapFile(path).value();
    EXPECT_EQ(blob, Blob::copyOf(bytes).value());
    EXPECT_TRUE(objects::placeOf(blob).has_value());
    const auto missing = Blob::mapFile(path + "2");
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message.find("data2: No such file"), std::string::npos) << missing.error().message;
    EXPECT_FALSE(Blob::mapFile(folder.path()));
}

TEST(Blob, cannotBeWrittenByOthers) {
    const Blob blob = Blob::copyOf(pattern(kLargeBytes)).value();
    const BlobPlace place = objects::placeOf(blob).value();
    const std::string path = "/proc/self/fd/" + std::to_string(place.fd);
    const int file = ::open(path.c_str(), O_RDWR);
    ASSERT_GE(file, 0);
    EXPECT_LT(::write(file, "x", 1), 0);
    EXPECT_NE(::ftruncate(file, 5), 0);
    EXPECT_EQ(::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0), MAP_FAILED);
    ::close(file);
}

TEST(Blob, opensInAnotherProcess) {
    const auto bytes = pattern(kLargeBytes);
    const Blob blob = Blob::copyOf(bytes).value();
    const BlobPlace place = objects::placeOf(blob).value();
    const pid_t child = ::fork();
    if (child == 0) {
        // A process that did not inherit the descriptor.
        ::close(place.fd);
        const auto opened = objects::openPlace(place, {.verifyName = true});
        ::_exit(opened && std::ranges::equal(opened.value().bytes(), bytes) ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
}

TEST(Blob, refusesForeignPlaces) {
    const Blob blob = Blob::copyOf(pattern(kLargeBytes)).value();
    const BlobPlace good = objects::placeOf(blob).value();
    EXPECT_TRUE(objects::openPlace(good, {.verifyName = true}));
    const auto problemOf = [](BlobPlace place) {
        const auto opened = objects::openPlace(place, {.verifyName = true});
        return opened ? std::string() : opened.error().message;
    };
    BlobPlace place = good;
    place.sizeBytes -= 1;
    EXPECT_NE(problemOf(place).find("it has 1048576 bytes"), std::string::npos) << problemOf(place);
    place = good;
    place.inode += 1;
    EXPECT_NE(problemOf(place).find("belongs to another file"), std::string::npos) << problemOf(place);
    place = good;
    place.name[0] ^= std::byte{1};
    EXPECT_NE(problemOf(place).find("another name"), std::string::npos) << problemOf(place);
    place = good;
    place.fd = 100'000;
    EXPECT_NE(problemOf(place).find("must be transferred"), std::string::npos) << problemOf(place);
    place = good;
    place.pid = INT32_MAX;
    EXPECT_NE(problemOf(place), "");

    const int unsealed = ::memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    ASSERT_EQ(::ftruncate(unsealed, static_cast<off_t>(kLargeBytes)), 0);
    struct stat found {};
    ASSERT_EQ(::fstat(unsealed, &found), 0);
    place = {good.name, kLargeBytes, ::getpid(), unsealed, found.st_ino};
    EXPECT_NE(problemOf(place).find("not sealed"), std::string::npos) << problemOf(place);
    ::close(unsealed);

    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    place.fd = ends[0];
    EXPECT_NE(problemOf(place), ""); // and does not block
    ::close(ends[0]);
    ::close(ends[1]);
}

TEST(Blob, keepsSmallContentsOffDescriptors) {
    EXPECT_FALSE(objects::placeOf(Blob::copyOf(pattern(100)).value()).has_value());
}

TEST(BlobAssembly, joinsPiecesAndIgnoresRepeats) {
    const auto bytes = pattern(1000);
    const std::span<const std::byte> all(bytes);
    objects::BlobAssembly assembly(objects::blobNameOf(bytes), bytes.size());
    EXPECT_FALSE(assembly.add(10, all.subspan(10, 10)));
    EXPECT_TRUE(assembly.add(0, all.first(600)));
    EXPECT_TRUE(assembly.add(500, all.subspan(500, 300)));
    EXPECT_TRUE(assembly.add(0, all.first(100)));
    EXPECT_FALSE(assembly.add(900, all.subspan(900, 100)));
    EXPECT_FALSE(assembly.add(800, all.subspan(100, 300)));
    EXPECT_FALSE(assembly.isComplete());
    EXPECT_TRUE(assembly.add(800, all.subspan(800)));
    ASSERT_TRUE(assembly.isComplete());
    EXPECT_TRUE(std::ranges::equal(assembly.finish().value().bytes(), bytes));
}

TEST(BlobAssembly, rejectsDamagedContents) {
    auto bytes = pattern(1000);
    objects::BlobAssembly assembly(objects::blobNameOf(bytes), bytes.size());
    bytes[7] ^= std::byte{1};
    assembly.add(0, bytes);
    EXPECT_FALSE(assembly.finish());
}

TEST(BlobStore, dropsUnusedBlobsBeyondItsLimit) {
    objects::BlobStore store(10'000);
    const Blob used = Blob::copyOf(pattern(4000, 99)).value();
    store.insert(used);
    std::vector<BlobName> names;
    for (unsigned seed = 0; seed < 50; ++seed) {
        Blob blob = Blob::copyOf(pattern(1000, seed)).value();
        names.push_back(blob.name());
        store.insert(blob);
        blob = Blob();
        EXPECT_FALSE(store.find(names.front()).empty()) << "found each time, so the hand passes it";
        EXPECT_LE(store.sizeBytes(), 11'000U);
    }
    EXPECT_EQ(store.find(used.name()), used);
    EXPECT_TRUE(store.find(names[1]).empty());
    EXPECT_FALSE(store.find(names.back()).empty());
}

} // namespace
} // namespace mural::test

// Admission of connecting nodes by their secrets.
#include "nodes/head/membership/node_acceptor.hpp"

#include <gtest/gtest.h>
#include <thread>

#include "transport/secure/secure_connection.hpp"

namespace mural {
namespace {

constexpr int64_t kPatienceMs = 20'000;

// Null: rejected.
std::unique_ptr<Connection> come(const NodeAcceptor& gate, int node, const SessionSecret& secret) {
    auto connection = connectTcp("127.0.0.1", static_cast<uint16_t>(gate.port()), Deadline::inMs(kPatienceMs));
    if (!connection) return nullptr;
    auto secure = SecureConnection::connecting(std::move(*connection), NodeAcceptor::nameOf(node), secret,
                                               Deadline::inMs(kPatienceMs));
    if (!secure) return nullptr;
    return std::move(*secure);
}

std::unique_ptr<Connection> waitTaken(NodeAcceptor& gate, int node) {
    const Deadline deadline = Deadline::inMs(kPatienceMs);
    while (!deadline.passed()) {
        if (auto connection = gate.take(node)) return connection;
        std::this_thread::yield();
    }
    return nullptr;
}

TEST(NodeAcceptor, identifiesNodesByTheirSecret) {
    auto gate = NodeAcceptor::open(true);
    ASSERT_TRUE(gate.ok()) << gate.error().message;
    auto a = makeSessionSecret();
    auto b = makeSessionSecret();
    (*gate)->expect(4, *a);
    (*gate)->expect(7, *b);
    auto nodeB = come(**gate, 7, *b);
    auto nodeA = come(**gate, 4, *a);
    ASSERT_TRUE(nodeA && nodeB);
    auto headB = waitTaken(**gate, 7);
    auto headA = waitTaken(**gate, 4);
    ASSERT_TRUE(headA && headB);
    const std::byte sent{42};
    ASSERT_TRUE(headB->write({&sent, 1}, Deadline::inMs(kPatienceMs)).ok());
    headB->flush();
    std::byte received{};
    ASSERT_TRUE(nodeB->read({&received, 1}, Deadline::inMs(kPatienceMs)).ok());
    EXPECT_EQ(received, sent);
}

TEST(NodeAcceptor, rejectsStrangersAndUsedSecrets) {
    auto gate = NodeAcceptor::open(true);
    ASSERT_TRUE(gate.ok());
    auto right = makeSessionSecret();
    (*gate)->expect(0, *right);
    // A silent connection must not delay others.
    auto silent = connectTcp("127.0.0.1", static_cast<uint16_t>((*gate)->port()), Deadline::inMs(kPatienceMs));
    ASSERT_TRUE(silent.ok());
    SessionSecret wrong = *right;
    wrong[31] ^= std::byte{1};
    EXPECT_EQ(come(**gate, 0, wrong), nullptr);
    EXPECT_EQ(come(**gate, 1, *right), nullptr);
    EXPECT_EQ((*gate)->take(0), nullptr);
    auto node = come(**gate, 0, *right);
    ASSERT_TRUE(node);
    EXPECT_NE(waitTaken(**gate, 0), nullptr);
    EXPECT_EQ(come(**gate, 0, *right), nullptr);
}

TEST(NodeAcceptor, convertsNodeNames) {
    EXPECT_EQ(NodeAcceptor::nodeOf(NodeAcceptor::nameOf(17)), 17);
    for (const char* other : {"", "node", "node-1", "node1x", "nod1"})
        EXPECT_FALSE(NodeAcceptor::nodeOf(other)) << other;
}

} // namespace
} // namespace mural

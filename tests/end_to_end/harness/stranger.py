"""A process on the network without the secret. It sends to a group's port the datagrams that it has received there,
repeated, changed and truncated, and invented ones. Run by network_faults.py; prints on one line how many datagrams
of each kind it sent.

  stranger.py GROUP PORT ADDRESS SECONDS    ADDRESS: of its own card
"""

import os
import random
import socket
import struct
import sys
import time

MAX_DATAGRAMS = 5000


def group_socket(group, port, address):
    s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    s.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    s.bind((group, port))
    s.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, struct.pack("4s4s", socket.inet_aton(group), socket.inet_aton(address)))
    s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(address))
    s.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 0)
    s.setblocking(False)
    return s


def changed(datagram):
    """Returns the datagram with one bit changed, with an unused counter, or truncated."""
    made = bytearray(datagram)
    kind = random.randrange(3)
    if kind == 0:
        made[random.randrange(len(made))] ^= 1 << random.randrange(8)
    elif kind == 1:
        made[8:16] = struct.pack("<Q", struct.unpack("<Q", made[8:16])[0] + random.randrange(1, 1 << 40))
    else:
        del made[random.randrange(len(made)):]
    return bytes(made)


def main():
    group, port, address, seconds = sys.argv[1], int(sys.argv[2]), sys.argv[3], float(sys.argv[4])
    s = group_socket(group, port, address)
    received, sent = [], {"heard": 0, "replayed": 0, "changed": 0, "random": 0}
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        try:
            for _ in range(100):
                datagram = s.recv(65536)
                if len(datagram) < 16:
                    continue
                sent["heard"] += 1
                if len(received) < MAX_DATAGRAMS:
                    received.append(datagram)
                else:
                    received[random.randrange(MAX_DATAGRAMS)] = datagram
        except BlockingIOError:
            pass
        for _ in range(5):
            made = {"random": os.urandom(random.randrange(1473))}
            if received:
                made["replayed"] = random.choice(received)
                made["changed"] = changed(random.choice(received[-100:]))
            for kind, datagram in made.items():
                s.sendto(datagram, (group, port))
                sent[kind] += 1
        time.sleep(0.005)
    print(" ".join("%s %d" % item for item in sent.items()), flush=True)


main()

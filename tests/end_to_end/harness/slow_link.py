"""A relay of TCP connections that delays each byte and limits the rate, because not every kernel has netem."""

import asyncio
import threading


class SlowLink:
    """Relays connections to `listen` on to `target`. Bytes arrive `seconds` later, in both directions. rate: most bytes
    per second of each direction and connection; None: no limit. A context manager; `port` is the port that listens."""

    PIECE = 1 << 20
    MOST_WAITING = 64  # pieces; then the sender waits
    LIMITED_PIECE = 1 << 12  # with a rate; at most 256 KiB wait, as in the buffers of a router

    def __init__(self, listen, target, seconds, rate=None):
        self.listen, self.target, self.seconds, self.rate = listen, target, seconds, rate
        self.port = None
        self.loop = asyncio.new_event_loop()
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.ready = threading.Event()

    def __enter__(self):
        self.thread.start()
        if not self.ready.wait(10):
            raise RuntimeError("the relay does not start")
        return self

    def __exit__(self, *_):
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join(10)

    def _run(self):
        asyncio.set_event_loop(self.loop)
        server = self.loop.run_until_complete(asyncio.start_server(self._serve, *self.listen))
        self.port = server.sockets[0].getsockname()[1]
        self.ready.set()
        self.loop.run_forever()
        tasks = asyncio.all_tasks(self.loop)
        for task in tasks:
            task.cancel()
        self.loop.run_until_complete(asyncio.gather(*tasks, return_exceptions=True))

    async def _serve(self, reader, writer):
        try:
            there, back = await asyncio.open_connection(*self.target)
        except OSError:
            writer.close()
            return
        await asyncio.gather(self._pump(reader, back), self._pump(there, writer))

    async def _pump(self, reader, writer):
        queue = asyncio.Queue(self.MOST_WAITING)

        async def send():
            free = 0  # time from which on the line can take the next piece
            while True:
                due, piece = await queue.get()
                due = max(due, free)
                await asyncio.sleep(max(0, due - self.loop.time()))
                free = due + (len(piece) / self.rate if self.rate else 0)
                if not piece:
                    writer.close()
                    return
                writer.write(piece)
                await writer.drain()

        sender = asyncio.ensure_future(send())
        try:
            while True:
                piece = await reader.read(self.LIMITED_PIECE if self.rate else self.PIECE)
                await queue.put((self.loop.time() + self.seconds, piece))
                if not piece:
                    break
            await sender
        except OSError:
            writer.close()
        finally:
            sender.cancel()

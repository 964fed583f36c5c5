"""A relay of TCP connections that delays each byte, because not every kernel has netem."""

import asyncio
import threading


class SlowLink:
    """Relays connections to `listen` on to `target`. Bytes arrive `seconds` later, in both directions. A context
    manager."""

    PIECE = 1 << 20
    MOST_WAITING = 64  # pieces; then the sender waits

    def __init__(self, listen, target, seconds):
        self.listen, self.target, self.seconds = listen, target, seconds
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
        self.loop.run_until_complete(asyncio.start_server(self._serve, *self.listen))
        self.ready.set()
        self.loop.run_forever()

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
            while True:
                due, piece = await queue.get()
                await asyncio.sleep(max(0, due - self.loop.time()))
                if not piece:
                    writer.close()
                    return
                writer.write(piece)
                await writer.drain()

        sender = asyncio.ensure_future(send())
        try:
            while True:
                piece = await reader.read(self.PIECE)
                await queue.put((self.loop.time() + self.seconds, piece))
                if not piece:
                    break
            await sender
        except OSError:
            sender.cancel()
            writer.close()

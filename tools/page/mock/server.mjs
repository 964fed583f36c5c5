// A server that speaks the wire of the page with a made-up session, for work on the page and for its tests.
//   node mock/server.mjs [PORT] [slow] [lost] [video]      tokens: operate-token, input-token, view-token
import { existsSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { WebSocketServer } from 'ws';
import { perform, Refusal } from './operations.mjs';
import { kConfiguration, kDrawing, readTiles, readUnits, Scene } from './scene.mjs';

const kTypes = { html: 'text/html; charset=utf-8', js: 'text/javascript; charset=utf-8', css: 'text/css; charset=utf-8', svg: 'image/svg+xml' };
const kTokens = { 'operate-token': 'operate', 'input-token': 'input', 'view-token': 'view' };
const kSizes = { thumb: [320, 180], preview: [960, 540], full: [1280, 720] };
const kFrameMs = 1000 / 24;
const [kKeyFrame, kLastOfFrame] = [1, 2];

function part(kind, flags, stream, frame, lastInput, rect, size, payload) {
    const header = Buffer.alloc(36);
    header.writeUInt8(1, 0);
    header.writeUInt8(kind, 1);
    header.writeUInt16LE(flags, 2);
    header.writeUInt32LE(stream, 4);
    header.writeBigUInt64LE(BigInt(frame), 8);
    header.writeUInt32LE(lastInput, 16);
    [...rect, ...size].forEach((value, i) => header.writeUInt16LE(value, 20 + 2 * i));
    header.writeUInt32LE(payload.length, 32);
    return Buffer.concat([header, payload]);
}

export class Mock {
    scene = new Scene();
    clients = new Set();
    inputs = [];
    requests = [];
    acks = 0;
    isRefusing = false;
    bytesOfFirstLoad = 0;
    lastClient = 0;

    // `folder` has the built page. `video`: H.264 for clients that decode it. `isQuiet`: no frames but those of step().
    constructor({ folder, video = false, isQuiet = false }) {
        this.folder = folder;
        this.video = video;
        this.tiles = readTiles();
        this.units = readUnits();
        this.server = createServer((request, response) => this.serve(request, response));
        this.sockets = new WebSocketServer({ noServer: true, handleProtocols: () => 'mural.v1' });
        this.server.on('upgrade', (request, socket, head) => {
            if (this.isRefusing || request.url !== '/ws') return socket.destroy();
            this.sockets.handleUpgrade(request, socket, head, web => this.greet(web));
        });
        if (!isQuiet) this.timer = setInterval(() => this.step(), kFrameMs);
    }

    listen(port = 0) {
        return new Promise(resolve => this.server.listen(port, '127.0.0.1', () => resolve(this.server.address().port)));
    }

    close() {
        clearInterval(this.timer);
        this.drop();
        this.server.closeAllConnections();
        return new Promise(resolve => this.server.close(resolve));
    }

    // Ends all connections, as a lost network does.
    drop() {
        for (const client of this.clients) client.web.terminate();
    }

    // Passes time in the session, and sends what is due; without `seconds` the time of one frame.
    step(seconds) {
        this.scene.step(seconds);
        for (const client of this.clients) {
            this.sendTopics(client, performance.now());
            this.sendPictures(client);
        }
        this.scene.events = [];
    }

    serve(request, response) {
        const path = request.url.split('?')[0];
        const headers = {
            'Content-Security-Policy': "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'", 'Cache-Control': 'no-store', 'X-Content-Type-Options': 'nosniff',
            'Referrer-Policy': 'no-referrer',
        };
        if (path.startsWith('/api/')) return this.serveDocument(path, request, response, headers);
        const name = path === '/' ? 'index.html' : path.slice(1);
        const file = `${this.folder}/${name}`;
        if (!/^[\w.]+$/.test(name) || !existsSync(file)) return response.writeHead(404, headers).end();
        const body = gzipSync(readFileSync(file), { level: 9 });
        this.bytesOfFirstLoad += body.length;
        response.writeHead(200, { ...headers, 'Content-Type': kTypes[name.split('.').pop()], 'Content-Encoding': 'gzip' }).end(body);
    }

    serveDocument(path, request, response, headers) {
        const role = kTokens[(request.headers.authorization ?? '').replace('Bearer ', '')];
        const fail = (status, error) => response.writeHead(status, { ...headers, 'Content-Type': 'application/json' }).end(JSON.stringify({ error }));
        if (!role) return fail(401, 'this link is unknown, expired or revoked');
        const send = (type, body) => response.writeHead(200, { ...headers, 'Content-Type': type }).end(body);
        if (path === '/api/v1/trace.json') return send('application/json', JSON.stringify({ traceEvents: [] }));
        if (path === '/api/v1/picture.jpg') return send('image/jpeg', this.tiles[0][0]);
        if (role !== 'operate') return fail(403, 'this document requires the role operate');
        if (path === '/api/v1/config.eqc') return send('text/plain; charset=utf-8', kConfiguration);
        if (path === '/api/v1/config.svg') return send('image/svg+xml', kDrawing);
        const node = /^\/api\/v1\/nodes\/(\d+)\/log$/.exec(path);
        if (node) return send('application/json', JSON.stringify({ lines: this.scene.log.filter(line => line.topic !== 'node' || line.text.includes(`node ${node[1]}`)) }));
        return fail(404, 'no such document');
    }

    greet(web) {
        const timer = setTimeout(() => web.close(4401, 'no greeting'), 5000);
        web.once('message', data => {
            clearTimeout(timer);
            const { hello } = JSON.parse(data.toString());
            const role = kTokens[hello?.token];
            if (!role) return web.close(4401, 'this link is unknown, expired or revoked');
            const client = {
                web, role, client: ++this.lastClient, name: hello.name, hello, topics: new Map(), previews: new Map(), lastInput: 0,
                inFlight: 0, unit: 0, needsKey: true,
            };
            this.clients.add(client);
            web.on('close', () => this.leave(client));
            web.on('message', message => this.receive(client, JSON.parse(message.toString())));
            const session = { protocol: 1, mural: '0.1.0', session: this.scene.status.session, runPid: 4700, headPid: 4711 };
            client.web.send(JSON.stringify({ welcome: { role, session, client: client.client, limits: { textBytes: 65536 } } }));
            this.announceClients();
        });
    }

    leave(client) {
        this.clients.delete(client);
        if (this.scene.holder === client.client) this.scene.holder = null;
        this.announceClients();
    }

    announceClients() {
        const data = [...this.clients].map(({ client, name, role }) => ({ client, name, role, holder: client === this.scene.holder }));
        for (const client of this.clients)
            if (client.topics.has('clients')) client.web.send(JSON.stringify({ topic: 'clients', dropped: 0, data }));
    }

    receive(client, message) {
        if (message.ping !== undefined) return client.web.send(JSON.stringify({ pong: message.ping, serverMs: performance.now() }));
        if (message.ack) {
            ++this.acks;
            client.inFlight = Math.max(0, client.inFlight - 1);
            return;
        }
        if (message.input) {
            if (this.scene.holder !== client.client) return;
            this.inputs.push(message.input);
            client.lastInput = message.input.seq;
            return;
        }
        this.requests.push({ op: message.op, args: message.args, role: client.role });
        let reply;
        try {
            reply = { id: message.id, ok: true, result: perform(this.scene, client, message.op, message.args) };
        } catch (error) {
            if (!(error instanceof Refusal)) throw error;
            reply = { id: message.id, ok: false, code: error.code, error: error.message };
        }
        client.web.send(JSON.stringify(reply));
        if (['input-take', 'input-release', 'subscribe'].includes(message.op)) this.announceClients();
    }

    sendTopics(client, nowMs) {
        for (const [topic, subscription] of client.topics) {
            if (topic === 'clients') continue;
            if (topic === 'events' && this.scene.events.length) client.web.send(JSON.stringify({ topic, dropped: 0, data: this.scene.events }));
            if (topic === 'events' || nowMs < subscription.nextMs) continue;
            const isFirst = subscription.nextMs === 0;
            subscription.nextMs = nowMs + subscription.interval;
            const data = this.dataOf(topic, subscription, isFirst);
            if (data) client.web.send(JSON.stringify({ topic, dropped: 0, data }));
        }
    }

    dataOf(topic, subscription, isFirst) {
        if (topic === 'status') return this.scene.status;
        if (topic === 'outputs') return this.scene.outputs();
        if (topic === 'timeline') return this.scene.frames(isFirst ? 300 : Math.round((subscription.interval / 1000) * 24));
        const news = this.scene.log.filter(line => !(line.atSeconds <= subscription.seenSeconds));
        subscription.seenSeconds = this.scene.seconds;
        return news.length ? news : null;
    }

    sendPictures(client) {
        if (client.inFlight >= 2) return;
        for (const [of, kind] of client.previews) {
            if (kind === 'off' || (kind === 'thumb' && this.scene.frame % 12)) continue;
            const stream = of === 'wall' ? 0 : of === 'desktop' ? 0xffffffff : 1 + of;
            const isVideo = this.video && client.hello.canUse?.h264 && stream === 0;
            client.web.send(isVideo ? this.videoUnit(client) : this.jpegFrame(client, stream, kSizes[kind]));
            ++client.inFlight;
        }
    }

    // Shows the pointer of the program at a place in fractions; an empty shape keeps the earlier one.
    sendCursor(shape, place, hot = [0, 0], isHidden = false) {
        const at = place.map(value => Math.round(value * 65535));
        for (const { web } of this.clients) web.send(part(3, isHidden ? 8 : 0, 0, 0, 0, [...at, ...hot], [1, 1], shape));
    }

    jpegFrame(client, stream, size) {
        const tiles = this.tiles[(this.scene.frame >> 2) % this.tiles.length];
        const [w, h] = [size[0] / 2, size[1] / 2];
        return Buffer.concat(tiles.map((tile, i) => part(1, i === 3 ? kLastOfFrame : 0, stream, this.scene.frame, client.lastInput,
            [(i % 2) * w, (i >> 1) * h, w, h], size, tile)));
    }

    videoUnit(client) {
        if (client.needsKey) client.unit = 0;
        client.needsKey = false;
        const at = client.unit++ % this.units.length;
        return part(2, kLastOfFrame | (at === 0 ? kKeyFrame : 0), 0, this.scene.frame, client.lastInput, [0, 0, 640, 360], [640, 360], this.units[at]);
    }
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
    const words = process.argv.slice(2);
    const mock = new Mock({ folder: fileURLToPath(new URL('../dist', import.meta.url)), video: words.includes('video') });
    mock.scene.isSlow = words.includes('slow');
    const port = await mock.listen(Number(words.find(word => /^\d+$/.test(word)) ?? 8787));
    if (words.includes('lost')) mock.scene.lose(3);
    console.log(`http://127.0.0.1:${port}/#t=operate-token`);
}

// The state of a made-up session from data of real ones: four nodes, one program, an equalizer. Time passes with step().
import { readFileSync } from 'node:fs';

const read = name => readFileSync(new URL(`data/${name}`, import.meta.url));
const json = name => JSON.parse(read(name).toString());

export const kConfiguration = readFileSync(new URL('../../../configs/wall-2x2.eqc', import.meta.url));
export const kDrawing = read('config.svg');
const kFrameSeconds = 1 / 24;
// Replay times of the nodes in ms; the slow node takes as much longer.
const kReplayMs = [6.1, 7.4, 6.6, 5.9];
const kSlowRatio = 3.1;
const kSlowNode = 2;

// Returns the JPEG tiles of the recorded pictures: four of 320x180 each.
export function readTiles() {
    const bytes = read('tiles.bin');
    const tiles = [];
    for (let at = 0; at < bytes.length; ) {
        const size = bytes.readUInt32LE(at);
        tiles.push(bytes.subarray(at + 4, at + 4 + size));
        at += 4 + size;
    }
    return Array.from({ length: tiles.length / 4 }, (_, i) => tiles.slice(4 * i, 4 * i + 4));
}

// Returns the access units of the recorded video. Each begins with a delimiter (type 9).
export function readUnits() {
    const bytes = read('video.h264');
    const begins = [];
    for (let i = 0; i + 4 < bytes.length; ++i)
        if (bytes[i] === 0 && bytes[i + 1] === 0 && bytes[i + 2] === 1 && (bytes[i + 3] & 31) === 9) begins.push(bytes[i - 1] === 0 ? i - 1 : i);
    return begins.map((begin, i) => bytes.subarray(begin, begins[i + 1]));
}

export class Scene {
    frame = 4200;
    seconds = 1800;
    frozenOutputs = new Set();
    names = ['upper.left', 'upper.right', 'lower.left', 'lower.right'];
    overlays = new Map();
    log = [];
    events = [];
    links = [];
    holder = null;
    isSlow = false;

    constructor() {
        this.status = json('status.json');
        this.plan = json('plan.json');
        this.status.equalizers = json('equalizers.json').equalizers;
        this.status.equalizers[0].nodes.forEach((entry, i) => (entry.part = [0.24, 0.31, 0.19, 0.26][i]));
        this.status.tiles = '2x2';
        this.status.multicast = { bytes: 41e6, datagrams: 29400, repairs: 31, parity: 64 };
        this.recordedFrames = json('frames.json');
        this.nextFrame = 1;
        Object.assign(this.status.programs[0], {
            bytes: 38_400_000, calls: 612_000, roundTrips: 318,
            roundTripsBy: { glGetError: 201, glReadPixels: 64, glGetIntegerv: 41, glClientWaitSync: 12 },
        });
        this.status.nodes.forEach((node, i) => {
            Object.assign(node, {
                where: i < 2 ? 'wall1' : 'wänd-2', state: 'alive', stream: 'multicast', joins: 0, frames: this.frame,
                pictureBytes: 4e8, pictureRawBytes: 5.1e9, silentSeconds: 0.02, dropped: 0, lost: 5 * i, secondsToRejoin: 0, snapshotBytes: 0,
            });
        });
        this.addLog('info', 'session', 'the wall has 4 nodes on 2 hosts');
        this.addLog('info', 'program', 'glmark2 draws into a window of 1280x720 pixels');
    }

    addLog(level, topic, text) {
        this.log.push({ atSeconds: this.seconds, level, topic, text });
        if (this.log.length > 200) this.log.shift();
    }

    node(number) {
        return this.status.nodes.find(node => node.node === number);
    }

    lose(number) {
        const node = this.node(number);
        Object.assign(node, { state: 'lost', silentSeconds: 0 });
        const text = `node ${number} (${node.where}, pid ${node.pid}) was lost: signal 9 (Killed)`;
        this.addLog('warning', 'node', text);
        this.events.push({ event: 'node-lost', node: number, text });
    }

    revive(number) {
        const node = this.node(number);
        Object.assign(node, { state: 'alive', joins: node.joins + 1, secondsToRejoin: 1.4, snapshotBytes: 9_400_000, silentSeconds: 0 });
        this.events.push({ event: 'node-joined', node: number, joins: node.joins });
    }

    // Passes time in the session.
    step(seconds = kFrameSeconds) {
        const frames = Math.max(1, Math.round(seconds / kFrameSeconds));
        this.seconds += seconds;
        this.frame += frames;
        const { status } = this;
        status.atSeconds = this.seconds;
        status.frames = this.frame;
        const [program] = status.programs;
        Object.assign(program, { frames: this.frame, bytes: program.bytes + 9100 * frames, calls: program.calls + 147 * frames });
        program.waitSeconds.frames += seconds * 0.71;
        program.waitSeconds.reply += seconds * 0.04;
        if (this.frame % 60 < frames) { ++program.roundTrips; ++program.roundTripsBy.glGetError; }
        status.nodes.forEach((node, i) => {
            if (node.state !== 'alive') {
                node.silentSeconds += seconds;
                return;
            }
            const ratio = this.isSlow && node.node === kSlowNode ? kSlowRatio : 1;
            node.frames = this.frame;
            node.replaySeconds += (kReplayMs[i % 4] * ratio * frames * (1 + 0.12 * Math.sin(this.frame / 9 + i))) / 1000;
            node.readbackSeconds += (0.9 * frames) / 1000;
            node.pictureBytes += frames * (41000 + 6000 * i);
            node.pictureRawBytes += frames * 921600;
            node.lost += this.frame % (97 + 13 * i) < frames ? 1 : 0;
        });
        if (status.recording) {
            status.recording.frames += frames;
            status.recording.bytes += frames * 9300;
        }
        if (status.revertsInSeconds !== null) {
            status.revertsInSeconds -= seconds;
            if (status.revertsInSeconds <= 0) status.revertsInSeconds = null;
        }
    }

    wall() {
        const places = [[8, 8], [628, 8], [8, 368], [628, 368]];
        return {
            canvases: [{
                name: 'wall', layout: 'whole', layouts: ['whole', '2D', 'off'], sizeMm: [1240, 720], sizePx: [1280, 720],
                segments: this.names.map((name, i) => ({
                    name: i === 3 ? '' : name, turn: 0, node: this.status.nodes[i]?.node ?? i, channel: name,
                    rectMm: [places[i][0], places[i][1], 604, 344],
                    rectPx: [i % 2 ? 648 : 8, i < 2 ? 8 : 368, 623, 344],
                })),
            }],
            program: { size: [1280, 720] },
        };
    }

    outputs() {
        return this.status.nodes.map((node, i) => {
            const isStill = node.state !== 'alive' || this.frozenOutputs.has(node.node);
            const frame = isStill ? this.stillFrames?.[i] ?? this.frame - 180 : this.frame - (i === 3 ? 1 : 0);
            if (isStill) (this.stillFrames ??= [])[i] = frame;
            return {
                output: this.names[i], node: node.node, frame,
                hash: (BigInt(frame * 8 + i) * 0x9e3779b97f4a7c15n & 0xffffffffffffffffn).toString(16).padStart(16, '0'),
                ageSeconds: isStill ? (this.frame - frame) * kFrameSeconds : 0.2 + 0.1 * i, skewMs: i < 2 ? 0.3 * i : null,
            };
        });
    }

    // Returns the next frames of the timeline: recorded ones, moved to the present.
    frames(many) {
        const { frames: recorded, kinds, clocks } = this.recordedFrames;
        const length = recorded[recorded.length - 1].doneNs - recorded[0].doneNs + 4e7;
        const result = [];
        for (let i = 0; i < many; ++i, ++this.nextFrame) {
            const source = recorded[this.nextFrame % recorded.length];
            const shift = Math.floor(this.nextFrame / recorded.length) * length;
            result.push({
                ...source, number: this.nextFrame, frame: 4000 + this.nextFrame, doneNs: source.doneNs + shift,
                tracks: source.tracks.map(track => ({ ...track, spans: track.spans.map(([kind, begin, end]) => {
                    const isShort = this.isSlow && track.process === 'node' && track.number !== kSlowNode;
                    return [kind, begin + shift, (isShort ? begin + (end - begin) * 0.4 : end) + shift];
                }) })),
            });
        }
        return { frames: result, next: this.nextFrame, more: false, kinds, clocks };
    }
}

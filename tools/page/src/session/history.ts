// Rates from totals: the difference of each two states of the session. Pure; bounded.

import type { NodeStatus, ProgramStatus, Status } from '../wire/types.ts';

export interface NodeRates {
    framesPerSecond: number;
    // Milliseconds per frame; NaN without a frame.
    replayMs: number;
    readbackMs: number;
    pictureBytes: number; // per second, as sent
    pictureRawBytes: number; // per second, before coding
}

export interface ProgramRates {
    framesPerSecond: number;
    bytes: number;
    calls: number;
    roundTrips: number;
    waitShare: Record<string, number>; // of the time, by cause
}

export interface Rates {
    atSeconds: number;
    framesPerSecond: number;
    nodes: Map<number, NodeRates>;
    programs: Map<number, ProgramRates>;
}

// States per second times this many seconds.
const kMostRates = 300;

// A counter of a restarted process begins again with zero.
function increase(now: number, before: number): number {
    return now >= before ? now - before : now;
}

function nodeRates(now: NodeStatus, before: NodeStatus, seconds: number): NodeRates {
    const frames = increase(now.frames, before.frames);
    return {
        framesPerSecond: frames / seconds,
        replayMs: frames ? (increase(now.replaySeconds, before.replaySeconds) / frames) * 1000 : NaN,
        readbackMs: frames ? (increase(now.readbackSeconds, before.readbackSeconds) / frames) * 1000 : NaN,
        pictureBytes: increase(now.pictureBytes, before.pictureBytes) / seconds,
        pictureRawBytes: increase(now.pictureRawBytes, before.pictureRawBytes) / seconds,
    };
}

function programRates(now: ProgramStatus, before: ProgramStatus, seconds: number): ProgramRates {
    const waitShare: Record<string, number> = {};
    for (const [cause, total] of Object.entries(now.waitSeconds))
        waitShare[cause] = Math.min(1, increase(total, before.waitSeconds[cause] ?? 0) / seconds);
    return {
        framesPerSecond: increase(now.frames, before.frames) / seconds,
        bytes: increase(now.bytes, before.bytes) / seconds,
        calls: increase(now.calls, before.calls) / seconds,
        roundTrips: increase(now.roundTrips, before.roundTrips) / seconds,
        waitShare,
    };
}

export function ratesBetween(now: Status, before: Status): Rates | null {
    const seconds = now.atSeconds - before.atSeconds;
    if (!(seconds > 0)) return null;
    const nodes = new Map<number, NodeRates>();
    for (const node of now.nodes) {
        const previous = before.nodes.find(other => other.node === node.node);
        if (previous) nodes.set(node.node, nodeRates(node, previous, seconds));
    }
    const programs = new Map<number, ProgramRates>();
    for (const program of now.programs) {
        const previous = before.programs.find(other => other.client === program.client);
        if (previous) programs.set(program.client, programRates(program, previous, seconds));
    }
    return { atSeconds: now.atSeconds, framesPerSecond: increase(now.frames, before.frames) / seconds, nodes, programs };
}

export class History {
    readonly rates: Rates[] = [];
    private previous: Status | null = null;

    add(status: Status): void {
        if (this.previous?.session !== status.session) this.rates.length = 0;
        else {
            const rates = ratesBetween(status, this.previous);
            if (rates) this.rates.push(rates);
            if (this.rates.length > kMostRates) this.rates.shift();
        }
        this.previous = status;
    }

    get latest(): Rates | null {
        return this.rates[this.rates.length - 1] ?? null;
    }
}

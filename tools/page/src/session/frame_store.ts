// The last frames of the session on one clock, and their summary. The means are those of mural stat.

import type { FrameRecord, FramesReply, Track } from '../wire/types.ts';
import { Cell } from './cell.ts';

export interface Stage {
    process: string; // program, head, node
    number: number; // of the node
    kind: string; // name of the state
    ms: number; // mean per frame
}

export interface FrameSummary {
    frames: number;
    frameMs: number;
    stages: Stage[]; // longest first
    slowest: Stage | null; // longest activity
}

const kMostFrames = 600;

export function isWait(kind: string): boolean {
    return kind.startsWith('wait');
}

export function placeOf(process: string, number: number): string {
    return process === 'node' ? `node ${number}` : process;
}

export function rowOf(track: Track): string {
    const place = placeOf(track.process, track.number);
    const isOfNode = track.process === 'head' && track.thread === 'reader';
    return isOfNode ? `head reader ${track.number}` : `${place} ${track.thread}`;
}

export function summarize(frames: FrameRecord[], kinds: string[]): FrameSummary {
    const counts = new Map<number, number>();
    for (const frame of frames) if (frame.doneNs) counts.set(frame.client, (counts.get(frame.client) ?? 0) + 1);
    const client = [...counts].sort((a, b) => b[1] - a[1])[0]?.[0];
    let done = 0;
    let first = Infinity;
    let last = -Infinity;
    for (const frame of frames) {
        if (frame.client !== client || !frame.doneNs) continue;
        ++done;
        first = Math.min(first, frame.doneNs);
        last = Math.max(last, frame.doneNs);
    }
    const sums = new Map<string, Stage>();
    for (const frame of frames)
        for (const track of frame.tracks)
            for (const [kind, begin, end] of track.spans) {
                const number = track.process === 'node' ? track.number : 0;
                const name = kinds[kind] ?? `state ${kind}`;
                const key = `${track.process} ${number} ${name}`;
                let stage = sums.get(key);
                if (!stage) sums.set(key, (stage = { process: track.process, number, kind: name, ms: 0 }));
                stage.ms += (end - begin) / 1e6 / Math.max(1, done);
            }
    const stages = [...sums.values()].sort((a, b) => b.ms - a.ms);
    return {
        frames: done,
        frameMs: done > 1 ? (last - first) / 1e6 / (done - 1) : NaN,
        stages,
        slowest: stages.find(stage => !isWait(stage.kind)) ?? null,
    };
}

export class FrameStore {
    frames: FrameRecord[] = [];
    kinds: string[] = [];
    clocks: FramesReply['clocks'] = [];
    readonly version = new Cell(0);

    add(reply: FramesReply): void {
        this.kinds = reply.kinds;
        this.clocks = reply.clocks;
        const lastNumber = this.frames[this.frames.length - 1]?.number ?? 0;
        const firstNew = reply.frames[0]?.number ?? 0;
        // Numbers that begin again belong to another session.
        if (reply.next <= lastNumber && firstNew <= lastNumber && reply.next < (this.frames[0]?.number ?? 0)) this.frames = [];
        const known = this.frames[this.frames.length - 1]?.number ?? 0;
        const added = reply.frames.filter(frame => frame.number > known);
        if (added.length) this.frames = [...this.frames, ...added].slice(-kMostFrames);
        ++this.version.value;
    }

    clear(): void {
        this.frames = [];
        ++this.version.value;
    }
}

// The pictures of the wall and of nodes: requests the greatest class that visible views want, and none while no view is
// visible. Distributes binary messages to their streams, and acknowledges frames.

import { parsePictureMessage } from '../wire/picture_message.ts';
import type { PictureClass } from '../wire/types.ts';
import { PictureStream } from './picture_stream.ts';

// The wall, the program's private display, or the part of a node.
export type PictureOf = 'wall' | 'desktop' | number;

export interface HubLink {
    request(op: string, args: Record<string, unknown>): Promise<unknown>;
    send(message: Record<string, unknown>): void;
    // The browser's decoder fails; the server shall send JPEG.
    onVideoGivenUp(): void;
    // A picture shows the effect of all input up to this number.
    onInputShown(lastInput: number): void;
}

const kRanks: PictureClass[] = ['off', 'thumb', 'preview', 'full'];
// Changes of visibility within this time are one request.
const kSettleMs = 60;
const kFirstMs = 2000;
const kDesktopStream = 0xffffffff;

function streamOf(of: PictureOf): number {
    return of === 'wall' ? 0 : of === 'desktop' ? kDesktopStream : 1 + of;
}

function pictureOf(stream: number): PictureOf {
    return stream === 0 ? 'wall' : stream === kDesktopStream ? 'desktop' : stream - 1;
}

// Returns the class for a picture of this many device pixels.
export function classForWidth(pixels: number): PictureClass {
    return pixels <= 340 ? 'thumb' : pixels <= 1400 ? 'preview' : 'full';
}

export class PictureHub {
    private readonly streams = new Map<number, PictureStream>();
    private readonly demands = new Map<PictureOf, Map<symbol, PictureClass>>();
    private readonly requested = new Map<PictureOf, PictureClass>();
    private settling: ReturnType<typeof setTimeout> | undefined;

    constructor(private readonly link: HubLink) {
        document.addEventListener('visibilitychange', () => this.settle());
    }

    stream(of: PictureOf): PictureStream {
        const number = streamOf(of);
        let stream = this.streams.get(number);
        if (!stream) {
            stream = new PictureStream({
                onShown: (frame, lastInput, shownMs) => {
                    this.link.send({ ack: { frame, shownMs: Math.round(shownMs * 10) / 10 } });
                    if (typeof of === 'string' && lastInput > 0) this.link.onInputShown(lastInput);
                },
                onDropped: frame => this.link.send({ ack: { frame, shownMs: 0 } }),
                onKeyFrameWanted: () => this.renew(of),
                onVideoGivenUp: () => this.link.onVideoGivenUp(),
            });
            this.streams.set(number, stream);
        }
        return stream;
    }

    // Declares that a visible view wants a class; `off` withdraws it.
    want(view: symbol, of: PictureOf, wanted: PictureClass): void {
        let demand = this.demands.get(of);
        if (!demand) this.demands.set(of, (demand = new Map()));
        if (wanted === 'off') demand.delete(view);
        else demand.set(view, wanted);
        this.settle();
    }

    // Requests all wanted classes again, after a new connection. With `isPictureSoon` it requests the wall before a view
    // has measured its size, which makes the first picture a fifth of a second faster.
    onConnected(isPictureSoon: boolean): void {
        this.requested.clear();
        if (isPictureSoon && document.visibilityState === 'visible') {
            const first = Symbol();
            this.want(first, 'wall', 'preview');
            setTimeout(() => this.want(first, 'wall', 'off'), kFirstMs);
        }
        for (const stream of this.streams.values()) stream.endVideo();
        this.apply();
    }

    onMessage(message: ArrayBuffer): void {
        let parts;
        try {
            parts = parsePictureMessage(message);
        } catch {
            return;
        }
        for (const part of parts) this.stream(pictureOf(part.stream)).accept(part);
    }

    private settle(): void {
        this.settling ??= setTimeout(() => {
            this.settling = undefined;
            this.apply();
        }, kSettleMs);
    }

    private apply(): void {
        for (const [of, demand] of this.demands) {
            let rank = 0;
            if (document.visibilityState === 'visible')
                for (const wanted of demand.values()) rank = Math.max(rank, kRanks.indexOf(wanted));
            const wanted = kRanks[rank]!;
            if ((this.requested.get(of) ?? 'off') !== wanted) this.ask(of, wanted);
        }
    }

    private ask(of: PictureOf, wanted: PictureClass): void {
        this.requested.set(of, wanted);
        this.link.request('preview', { class: wanted, of }).then(() => this.stream(of).setProblem(''), (error: unknown) => {
            // A later change of the demand asks again.
            if (this.requested.get(of) === wanted) this.requested.delete(of);
            this.stream(of).setProblem(error instanceof Error ? error.message : String(error));
        });
    }

    // A repeated request makes the server begin with a key frame.
    private renew(of: PictureOf): void {
        const wanted = this.requested.get(of);
        if (wanted && wanted !== 'off') this.ask(of, wanted);
    }
}

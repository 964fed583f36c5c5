// The newest picture of one stream, in a canvas that no view shows. Views draw parts of it. JPEG and PNG are decoded by
// createImageBitmap and H.264 by WebCodecs: both use threads of the browser, so this code needs no worker.

import { PartKind, type PicturePart } from '../wire/picture_message.ts';
import { VideoPath } from './video_path.ts';

export interface Cursor {
    picture: ImageBitmap;
    // Place in the program's window, as fractions.
    x: number;
    y: number;
    isHidden: boolean;
    // Pixels of the picture.
    hotX: number;
    hotY: number;
}

export interface StreamEvents {
    // A frame is complete in the canvas. `shownMs` is the time from its arrival to now.
    onShown(frame: number, lastInput: number, shownMs: number): void;
    // No picture shows this frame. The server counts it as shown, and sends the next ones.
    onDropped(frame: number): void;
    onKeyFrameWanted(): void;
    onVideoGivenUp(): void;
}

export type Coding = 'none' | 'JPEG' | 'H.264' | 'PNG';

interface Arrival {
    lastInput: number;
    atMs: number;
}

const kMostArrivals = 64;

export class PictureStream {
    readonly canvas = document.createElement('canvas');
    frame = 0;
    coding: Coding = 'none';
    isStill = false;
    // Why the server sends no pictures; empty: it sends them.
    problem = '';
    cursor: Cursor | null = null;
    private readonly listeners = new Set<() => void>();
    private readonly arrivals = new Map<number, Arrival>();
    private video: VideoPath | null = null;
    // Parts are drawn in the order of their arrival, although decoding takes different times.
    private tail: Promise<void> = Promise.resolve();

    constructor(private readonly events: StreamEvents) {
        this.canvas.width = this.canvas.height = 0;
    }

    get hasPicture(): boolean {
        return this.canvas.width > 0;
    }

    // Calls `listener` after each complete frame. Returns the end of that.
    listen(listener: () => void): () => void {
        this.listeners.add(listener);
        return () => this.listeners.delete(listener);
    }

    accept(part: PicturePart): void {
        if (part.kind === PartKind.H264) this.acceptVideo(part);
        else if (part.kind === PartKind.Cursor) this.acceptCursor(part);
        else if (part.kind === PartKind.Jpeg || part.kind === PartKind.Png) this.acceptStill(part);
    }

    setProblem(problem: string): void {
        if (this.problem === problem) return;
        this.problem = problem;
        this.announce();
    }

    // Forgets the decoder, such as after the end of the connection. The picture stays.
    endVideo(): void {
        this.video?.close();
        this.video = null;
        this.arrivals.clear();
    }

    private acceptStill(part: PicturePart): void {
        const atMs = performance.now();
        const type = part.kind === PartKind.Png ? 'image/png' : 'image/jpeg';
        const decoded = part.payload.length
            ? createImageBitmap(new Blob([part.payload], { type })).catch(() => null)
            : Promise.resolve(null);
        this.tail = this.tail.then(async () => {
            const picture = await decoded;
            this.fitCanvas(part);
            if (picture) {
                this.context().drawImage(picture, part.x, part.y, part.width, part.height);
                picture.close();
            }
            if (!part.isLast) return;
            this.coding = part.kind === PartKind.Png ? 'PNG' : 'JPEG';
            this.isStill = part.isStill;
            this.show(part.frame, part.lastInput, atMs);
        });
    }

    private acceptVideo(part: PicturePart): void {
        this.video ??= new VideoPath({
            onPicture: (picture, frame) => this.drawVideo(picture, frame),
            onKeyFrameWanted: () => {
                this.dropArrivals();
                this.events.onKeyFrameWanted();
            },
            onGiveUp: () => this.events.onVideoGivenUp(),
        });
        this.arrivals.set(part.frame, { lastInput: part.lastInput, atMs: performance.now() });
        if (this.arrivals.size > kMostArrivals) this.arrivals.delete(this.arrivals.keys().next().value!);
        this.fitCanvas(part);
        if (this.video.accept(part) || !this.arrivals.delete(part.frame)) return;
        this.events.onDropped(part.frame);
    }

    private dropArrivals(): void {
        const frames = [...this.arrivals.keys()];
        this.arrivals.clear();
        for (const frame of frames) this.events.onDropped(frame);
    }

    private drawVideo(picture: VideoFrame, frame: number): void {
        this.context().drawImage(picture, 0, 0, this.canvas.width, this.canvas.height);
        picture.close();
        const arrival = this.arrivals.get(frame);
        for (const number of this.arrivals.keys()) if (number <= frame) this.arrivals.delete(number);
        this.coding = 'H.264';
        this.isStill = false;
        this.show(frame, arrival?.lastInput ?? 0, arrival?.atMs ?? performance.now());
    }

    private acceptCursor(part: PicturePart): void {
        const decoded = part.payload.length
            ? createImageBitmap(new Blob([part.payload], { type: 'image/png' })).catch(() => null)
            : Promise.resolve(this.cursor?.picture ?? null);
        this.tail = this.tail.then(async () => {
            const picture = await decoded;
            // A move that follows a shape may be decoded before it.
            const shown = part.payload.length ? picture : this.cursor?.picture ?? picture;
            if (this.cursor && this.cursor.picture !== shown) this.cursor.picture.close();
            this.cursor = shown && {
                picture: shown, x: part.x / 65535, y: part.y / 65535, isHidden: part.isHidden, hotX: part.width, hotY: part.height,
            };
            this.announce();
        });
    }

    private fitCanvas(part: PicturePart): void {
        if (this.canvas.width === part.pictureWidth && this.canvas.height === part.pictureHeight) return;
        if (part.pictureWidth === 0 || part.pictureHeight === 0) return;
        // The previous picture remains as the background of the first tiles of another class.
        const previous = this.hasPicture ? this.copy() : null;
        this.canvas.width = part.pictureWidth;
        this.canvas.height = part.pictureHeight;
        if (previous) this.context().drawImage(previous, 0, 0, part.pictureWidth, part.pictureHeight);
    }

    private copy(): HTMLCanvasElement {
        const copy = document.createElement('canvas');
        copy.width = this.canvas.width;
        copy.height = this.canvas.height;
        copy.getContext('2d')!.drawImage(this.canvas, 0, 0);
        return copy;
    }

    private context(): CanvasRenderingContext2D {
        return this.canvas.getContext('2d', { alpha: false })!;
    }

    private show(frame: number, lastInput: number, arrivedMs: number): void {
        this.frame = frame;
        this.announce();
        this.events.onShown(frame, lastInput, performance.now() - arrivedMs);
    }

    private announce(): void {
        for (const listener of this.listeners) listener();
    }
}

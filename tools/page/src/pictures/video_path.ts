// Decoding of one H.264 stream by WebCodecs, with a watchdog: a decoder that takes units and returns nothing is replaced,
// and after a second failure the stream gives up. The caller then continues with JPEG.

export interface VideoUnit {
    isKeyFrame: boolean;
    frame: number;
    payload: Uint8Array<ArrayBuffer>;
}

export interface VideoPathEvents {
    onPicture(picture: VideoFrame, frame: number): void;
    // The decoder has failed: no unit so far returns a picture. A new decoder waits for a key frame.
    onKeyFrameWanted(): void;
    onGiveUp(): void;
}

const kStallMs = 1000;
const kStallUnits = 2;
const kMostFailures = 2;
// Units in the decoder's queue above which the path drops units up to the next key frame.
const kMostQueued = 30;

// Returns the codec of the sequence parameter set in an access unit, such as avc1.42e01f. Missing: constrained baseline.
export function codecOf(unit: Uint8Array): string {
    for (let i = 0; i + 6 < unit.length; ++i) {
        if (unit[i] !== 0 || unit[i + 1] !== 0 || unit[i + 2] !== 1 || (unit[i + 3]! & 31) !== 7) continue;
        const hex = (byte: number) => byte.toString(16).padStart(2, '0');
        return 'avc1.' + hex(unit[i + 4]!) + hex(unit[i + 5]!) + hex(unit[i + 6]!);
    }
    return 'avc1.42e01f';
}

// Returns whether this browser decodes H.264 here. Plain http to another machine hides the decoder.
export async function canDecodeVideo(): Promise<boolean> {
    if (typeof VideoDecoder === 'undefined') return false;
    try {
        return (await VideoDecoder.isConfigSupported({ codec: 'avc1.42e01f', optimizeForLatency: true })).supported === true;
    } catch {
        return false;
    }
}

export class VideoPath {
    private decoder: VideoDecoder | null = null;
    private needsKeyFrame = true;
    private unitsSinceOutput = 0;
    private firstUnansweredMs = 0;
    private failures = 0;
    private prefersSoftware = false;
    private readonly watchdog: ReturnType<typeof setInterval>;

    constructor(private readonly events: VideoPathEvents) {
        this.watchdog = setInterval(() => this.watch(), 250);
    }

    // Decodes a unit. The result comes later, and never blocks the caller. Returns false for a unit without a result.
    accept(unit: VideoUnit): boolean {
        if (this.failures >= kMostFailures) return false;
        if (this.decoder && this.decoder.decodeQueueSize > kMostQueued) this.needsKeyFrame = true;
        if (this.needsKeyFrame && !unit.isKeyFrame) return false;
        if (this.unitsSinceOutput++ === 0) this.firstUnansweredMs = performance.now();
        try {
            if (!this.decoder) this.decoder = this.makeDecoder(unit.payload);
            this.needsKeyFrame = false;
            this.decoder.decode(
                new EncodedVideoChunk({
                    type: unit.isKeyFrame ? 'key' : 'delta',
                    // The number of the frame in the place of a time in us returns with the picture.
                    timestamp: unit.frame,
                    data: unit.payload,
                }),
            );
            return true;
        } catch {
            this.fail();
            return false;
        }
    }

    close(): void {
        clearInterval(this.watchdog);
        this.drop();
    }

    private makeDecoder(firstUnit: Uint8Array): VideoDecoder {
        const decoder = new VideoDecoder({
            output: picture => {
                if (decoder !== this.decoder) {
                    picture.close();
                    return;
                }
                this.unitsSinceOutput = 0;
                this.events.onPicture(picture, picture.timestamp);
            },
            error: () => {
                if (decoder === this.decoder) this.fail();
            },
        });
        decoder.configure({
            codec: codecOf(firstUnit),
            optimizeForLatency: true,
            hardwareAcceleration: this.prefersSoftware ? 'prefer-software' : 'no-preference',
        });
        return decoder;
    }

    private watch(): void {
        const stalls = this.unitsSinceOutput >= kStallUnits && performance.now() - this.firstUnansweredMs > kStallMs;
        if (stalls && this.failures < kMostFailures) this.fail();
    }

    private fail(): void {
        this.drop();
        this.prefersSoftware = true;
        if (++this.failures >= kMostFailures) this.events.onGiveUp();
        else this.events.onKeyFrameWanted();
    }

    private drop(): void {
        const decoder = this.decoder;
        this.decoder = null;
        this.needsKeyFrame = true;
        this.unitsSinceOutput = 0;
        if (decoder && decoder.state !== 'closed') decoder.close();
    }
}

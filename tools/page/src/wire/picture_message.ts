// Binary messages with parts of pictures. Pure. Accepts any bytes.

export const PartKind = { Jpeg: 1, H264: 2, Cursor: 3, Png: 4 } as const;

const kVersion = 1;
const kHeaderBytes = 36;
const kKeyFrame = 1;
const kLastOfFrame = 2;
const kStill = 4;
const kHidden = 8;

export interface PicturePart {
    kind: number;
    isKeyFrame: boolean;
    isLast: boolean;
    isStill: boolean;
    isHidden: boolean;
    stream: number;
    frame: number;
    lastInput: number;
    x: number;
    y: number;
    width: number;
    height: number;
    pictureWidth: number;
    pictureHeight: number;
    payload: Uint8Array<ArrayBuffer>;
}

// Returns the parts of a message. Throws RangeError for a message that ends within a part or has another version.
export function parsePictureMessage(message: ArrayBuffer): PicturePart[] {
    const view = new DataView(message);
    const parts: PicturePart[] = [];
    for (let at = 0; at < message.byteLength; ) {
        if (message.byteLength - at < kHeaderBytes) throw new RangeError('a picture message ends within a header');
        if (view.getUint8(at) !== kVersion) throw new RangeError('a picture message has an unknown version');
        const flags = view.getUint16(at + 2, true);
        const bytes = view.getUint32(at + 32, true);
        if (bytes > message.byteLength - at - kHeaderBytes) throw new RangeError('a picture message ends within a part');
        parts.push({
            kind: view.getUint8(at + 1),
            isKeyFrame: (flags & kKeyFrame) !== 0,
            isLast: (flags & kLastOfFrame) !== 0,
            isStill: (flags & kStill) !== 0,
            isHidden: (flags & kHidden) !== 0,
            stream: view.getUint32(at + 4, true),
            // Frame numbers stay below 2^53 for longer than any session.
            frame: view.getUint32(at + 8, true) + view.getUint32(at + 12, true) * 2 ** 32,
            lastInput: view.getUint32(at + 16, true),
            x: view.getUint16(at + 20, true),
            y: view.getUint16(at + 22, true),
            width: view.getUint16(at + 24, true),
            height: view.getUint16(at + 26, true),
            pictureWidth: view.getUint16(at + 28, true),
            pictureHeight: view.getUint16(at + 30, true),
            payload: new Uint8Array(message, at + kHeaderBytes, bytes),
        });
        at += kHeaderBytes + bytes;
    }
    return parts;
}

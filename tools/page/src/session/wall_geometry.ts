// Places of segments on their canvas. Pure.

import type { Canvas, Rect, Segment, Wall } from '../wire/types.ts';

// Returns the frame that encloses the canvas and all of its segments in mm: [x, y, width, height].
export function frameOf(canvas: Canvas): Rect {
    let [left, top, right, bottom] = [0, 0, canvas.sizeMm[0], canvas.sizeMm[1]];
    for (const { rectMm } of canvas.segments) {
        left = Math.min(left, rectMm[0]);
        top = Math.min(top, rectMm[1]);
        right = Math.max(right, rectMm[0] + rectMm[2]);
        bottom = Math.max(bottom, rectMm[1] + rectMm[3]);
    }
    return [left, top, Math.max(1, right - left), Math.max(1, bottom - top)];
}

// Returns the place of a rectangle within a frame, in percent.
export function percentOf(rect: Rect, frame: Rect): { left: string; top: string; width: string; height: string } {
    const text = (value: number) => `${Number(value.toFixed(3))}%`;
    return {
        left: text(((rect[0] - frame[0]) / frame[2]) * 100),
        top: text(((rect[1] - frame[1]) / frame[3]) * 100),
        width: text((rect[2] / frame[2]) * 100),
        height: text((rect[3] / frame[3]) * 100),
    };
}

// Returns the part of the canvas's picture that a segment shows, as fractions.
export function partOf(segment: Segment, canvas: Canvas): Rect {
    const [width, height] = [Math.max(1, canvas.sizePx[0]), Math.max(1, canvas.sizePx[1])];
    const [x, y, w, h] = segment.rectPx;
    return [x / width, y / height, w / width, h / height];
}

// Returns the wall with a name for each segment, and -1 for segments without a node.
export function withNames(wall: Wall): Wall {
    return {
        ...wall,
        canvases: wall.canvases.map(canvas => ({
            ...canvas,
            segments: canvas.segments.map((segment, i) => ({
                ...segment,
                name: segment.name || segment.channel || `segment ${i + 1}`,
                node: segment.node ?? -1,
            })),
        })),
    };
}

export function segmentsOfNode(wall: Wall | null, node: number): Segment[] {
    return (wall?.canvases ?? []).flatMap(canvas => canvas.segments.filter(segment => segment.node === node));
}

export function sizeText(canvas: Canvas): string {
    const [widthMm, heightMm] = canvas.sizeMm;
    const metres = (mm: number) => (mm / 1000).toFixed(2).replace(/0$/, '');
    const pixels = `${canvas.sizePx[0]} × ${canvas.sizePx[1]} px`;
    return widthMm > 0 ? `${metres(widthMm)} × ${metres(heightMm)} m, ${pixels}` : pixels;
}

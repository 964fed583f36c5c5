// Drawing of spans on one clock into a canvas, and the search for the span at a point. No state.

import { isWait, rowOf } from '../session/frame_store.ts';
import type { FrameRecord } from '../wire/types.ts';

export interface Span {
    row: string;
    kind: string;
    beginNs: number;
    endNs: number;
    frame: number;
}

export interface GanttRows {
    names: string[];
    spans: Map<string, Span[]>;
    beginNs: number;
    endNs: number;
}

export interface Range {
    fromNs: number;
    toNs: number;
}

export interface GanttColours {
    text: string;
    faint: string;
    line: string;
    row: string;
    wait: string;
    kinds: Record<string, string>;
}

export const kRowHeight = 22;
export const kAxisHeight = 22;
const kPlaces: Record<string, number> = { program: 0, head: 1, node: 2 };
const kThreads = ['gl', 'stream', 'replay', 'pictures', 'reader', 'output', 'window'];

// Returns the rows in the order of the data's way: program, head, nodes.
export function rowsOf(frames: FrameRecord[], kinds: string[]): GanttRows {
    const spans = new Map<string, Span[]>();
    const orders = new Map<string, number>();
    let beginNs = Infinity;
    let endNs = -Infinity;
    for (const frame of frames)
        for (const track of frame.tracks) {
            const row = rowOf(track);
            let list = spans.get(row);
            if (!list) {
                spans.set(row, (list = []));
                orders.set(row, (kPlaces[track.process] ?? 3) * 1e6 + kThreads.indexOf(track.thread) * 1e4 * (track.process === 'head' ? 1 : 0)
                    + track.number * 10 + kThreads.indexOf(track.thread));
            }
            for (const [kind, begin, end] of track.spans) {
                list.push({ row, kind: kinds[kind] ?? `state ${kind}`, beginNs: begin, endNs: end, frame: frame.frame });
                beginNs = Math.min(beginNs, begin);
                endNs = Math.max(endNs, end);
            }
        }
    const names = [...spans.keys()].sort((a, b) => orders.get(a)! - orders.get(b)!);
    return { names, spans, beginNs, endNs };
}

export function labelWidth(width: number): number {
    return width < 560 ? 84 : 120;
}

export function ganttHeight(rows: GanttRows): number {
    return kAxisHeight + Math.max(1, rows.names.length) * kRowHeight;
}

function tickMs(spanMs: number, pixels: number): number {
    const wanted = (spanMs / Math.max(1, pixels)) * 90;
    const power = 10 ** Math.floor(Math.log10(wanted));
    return [1, 2, 5, 10].map(factor => factor * power).find(step => step >= wanted) ?? power * 10;
}

export function drawGantt(canvas: HTMLCanvasElement, rows: GanttRows, frames: FrameRecord[], range: Range, colours: GanttColours): void {
    const scale = devicePixelRatio;
    const width = canvas.clientWidth;
    const height = ganttHeight(rows);
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
    const context = canvas.getContext('2d')!;
    context.scale(scale, scale);
    context.font = '11px system-ui, sans-serif';
    context.textBaseline = 'middle';
    const left = labelWidth(width);
    const perNs = (width - left) / (range.toNs - range.fromNs);
    const xOf = (ns: number) => left + (ns - range.fromNs) * perNs;

    rows.names.forEach((name, i) => {
        const top = kAxisHeight + i * kRowHeight;
        if (i % 2 === 0) {
            context.fillStyle = colours.row;
            context.fillRect(0, top, width, kRowHeight);
        }
        context.fillStyle = colours.text;
        context.fillText(width < 560 ? name.replace('program', 'prog') : name, 4, top + kRowHeight / 2, left - 8);
    });
    context.save();
    context.beginPath();
    context.rect(left, 0, width - left, height);
    context.clip();
    drawAxis(context, range, frames, xOf, width - left, height, colours);
    rows.names.forEach((name, i) => {
        const top = kAxisHeight + i * kRowHeight;
        for (const span of rows.spans.get(name)!) {
            if (span.endNs < range.fromNs || span.beginNs > range.toNs) continue;
            const x = Math.max(left, xOf(span.beginNs));
            const w = Math.max(0.75, Math.min(width, xOf(span.endNs)) - x);
            if (isWait(span.kind)) {
                context.fillStyle = colours.wait;
                context.fillRect(x, top + kRowHeight / 2 - 1.5, w, 3);
                continue;
            }
            context.fillStyle = colours.kinds[span.kind] ?? colours.faint;
            context.fillRect(x, top + 3, w, kRowHeight - 6);
            if (w > 42) {
                context.fillStyle = '#fff';
                context.fillText(span.kind, x + 4, top + kRowHeight / 2 + 0.5, w - 8);
            }
        }
    });
    context.restore();
}

function drawAxis(context: CanvasRenderingContext2D, range: Range, frames: FrameRecord[], xOf: (ns: number) => number,
    pixels: number, height: number, colours: GanttColours): void {
    const stepNs = tickMs((range.toNs - range.fromNs) / 1e6, pixels) * 1e6;
    context.fillStyle = colours.faint;
    context.strokeStyle = colours.line;
    context.lineWidth = 1;
    for (let ns = range.fromNs; ns < range.toNs; ns += stepNs) {
        const x = Math.round(xOf(ns)) + 0.5;
        context.beginPath();
        context.moveTo(x, kAxisHeight);
        context.lineTo(x, height);
        context.stroke();
        context.fillText(`${Number(((ns - range.fromNs) / 1e6).toFixed(2))} ms`, x + 3, kAxisHeight / 2);
    }
    context.strokeStyle = colours.faint;
    context.setLineDash([3, 3]);
    for (const frame of frames) {
        if (frame.doneNs < range.fromNs || frame.doneNs > range.toNs) continue;
        const x = Math.round(xOf(frame.doneNs)) + 0.5;
        context.beginPath();
        context.moveTo(x, kAxisHeight);
        context.lineTo(x, height);
        context.stroke();
    }
    context.setLineDash([]);
}

// Returns the span at a point of the canvas in CSS pixels.
export function spanAt(rows: GanttRows, range: Range, width: number, x: number, y: number): Span | null {
    const left = labelWidth(width);
    const name = rows.names[Math.floor((y - kAxisHeight) / kRowHeight)];
    if (x < left || !name) return null;
    const ns = range.fromNs + ((x - left) / (width - left)) * (range.toNs - range.fromNs);
    return rows.spans.get(name)!.find(span => span.beginNs <= ns && ns <= span.endNs) ?? null;
}

// Returns the range after a zoom by `factor` around a place (0: its begin, 1: its end), and a move by a part of its length.
export function changed(range: Range, factor: number, around: number, move: number): Range {
    const length = range.toNs - range.fromNs;
    const next = Math.min(6e11, Math.max(2e4, length * factor));
    const fromNs = range.fromNs + (length - next) * around + length * move;
    return { fromNs, toNs: fromNs + next };
}

// Events of an element of the page as input messages for the program. Places are fractions of the program's window, or
// of its display.

import type { Session } from './session.ts';

// A wheel step of most mice in pixels and lines of a DOM event.
const kPixelsPerStep = 100;
const kLinesPerStep = 3;
const kStep = 120;
const kMostWheel = 12000;
const kMostTextBytes = 60000;
const kLongPressMs = 550;
const kTapSlop = 10; // px

// Returns the place of a point in an element as fractions, limited to the element.
export function placeIn(box: { left: number; top: number; width: number; height: number }, x: number, y: number): { x: number; y: number } {
    const limit = (value: number) => Math.min(1, Math.max(0, value));
    return { x: limit((x - box.left) / Math.max(1, box.width)), y: limit((y - box.top) / Math.max(1, box.height)) };
}

// Returns the steps of a wheel event in 1/120 of a step.
export function wheelSteps(event: { deltaX: number; deltaY: number; deltaMode: number }): { dx: number; dy: number } {
    const perStep = event.deltaMode === 0 ? kPixelsPerStep : event.deltaMode === 1 ? kLinesPerStep : 1;
    const steps = (delta: number) => Math.max(-kMostWheel, Math.min(kMostWheel, Math.round((delta / perStep) * kStep)));
    return { dx: steps(event.deltaX), dy: steps(event.deltaY) };
}

// Returns the pieces of a text, each within the limit of a message.
export function piecesOf(text: string, mostBytes = kMostTextBytes): string[] {
    const pieces: string[] = [];
    let piece = '';
    let bytes = 0;
    for (const character of text) {
        const size = new TextEncoder().encode(JSON.stringify(character)).length - 2;
        if (bytes + size > mostBytes) {
            pieces.push(piece);
            piece = '';
            bytes = 0;
        }
        piece += character;
        bytes += size;
    }
    if (piece) pieces.push(piece);
    return pieces;
}

// The key that leaves the picture, because Tab belongs to the program.
export function leavesPicture(event: { key: string; shiftKey: boolean }): boolean {
    return event.key === 'F6' && event.shiftKey;
}

export class ProgramInput {
    private move: { x: number; y: number } | null = null;
    private moveTimer = 0;
    private longPress: ReturnType<typeof setTimeout> | undefined;
    private touchStart: { x: number; y: number } | null = null;
    private readonly held = new Set<string>();

    constructor(
        private readonly session: Session,
        private readonly element: HTMLElement,
        private readonly onLeave: () => void,
        private readonly of: 'wall' | 'desktop' = 'wall',
    ) {}

    // Begins to send events. Returns the end of that, which releases all that is held.
    listen(): () => void {
        const stop = new AbortController();
        const on = <Kind extends keyof HTMLElementEventMap>(kind: Kind, handle: (event: HTMLElementEventMap[Kind]) => void) =>
            this.element.addEventListener(kind, handle, { signal: stop.signal, passive: false });
        on('pointermove', event => this.onMove(event));
        on('pointerdown', event => this.onDown(event));
        on('pointerup', event => this.onUp(event));
        on('pointercancel', event => this.onUp(event));
        on('contextmenu', event => event.preventDefault());
        on('wheel', event => {
            event.preventDefault();
            this.flushMove();
            this.send('wheel', { ...this.place(event), ...wheelSteps(event) });
        });
        on('keydown', event => this.onKey(event, true));
        on('keyup', event => this.onKey(event, false));
        on('paste', event => {
            event.preventDefault();
            this.paste(event.clipboardData?.getData('text') ?? '');
        });
        on('blur', () => this.release());
        return () => {
            stop.abort();
            this.release();
            clearTimeout(this.longPress);
        };
    }

    paste(text: string): void {
        for (const piece of piecesOf(text)) this.send('text', { text: piece });
    }

    private send(kind: string, members: Record<string, unknown> = {}): void {
        const of = this.of === 'desktop' ? { of: this.of } : {};
        this.session.send({ input: { seq: this.session.input.next(), kind, ...of, ...members } });
    }

    private place(event: { clientX: number; clientY: number }): { x: number; y: number } {
        return placeIn(this.element.getBoundingClientRect(), event.clientX, event.clientY);
    }

    private release(): void {
        this.held.clear();
        this.flushMove();
        this.send('blur');
    }

    private onMove(event: PointerEvent): void {
        if (event.pointerType === 'touch') return this.onTouchMove(event);
        this.move = this.place(event);
        // One move per frame of the browser: later places replace earlier ones.
        this.moveTimer ||= requestAnimationFrame(() => {
            this.moveTimer = 0;
            this.flushMove();
        });
    }

    private flushMove(): void {
        if (this.moveTimer) cancelAnimationFrame(this.moveTimer);
        this.moveTimer = 0;
        if (this.move) this.send('move', this.move);
        this.move = null;
    }

    private onDown(event: PointerEvent): void {
        this.element.focus({ preventScroll: true });
        event.preventDefault();
        this.element.setPointerCapture(event.pointerId);
        if (event.pointerType === 'touch') return this.onTouchDown(event);
        this.flushMove();
        this.send('down', { ...this.place(event), button: event.button + 1 });
    }

    private onUp(event: PointerEvent): void {
        if (event.pointerType === 'touch') return this.onTouchUp(event);
        this.flushMove();
        this.send('up', { ...this.place(event), button: event.button + 1 });
    }

    // The first finger is a touch. A long press is the right button. Further fingers are ignored.
    private onTouchDown(event: PointerEvent): void {
        if (!event.isPrimary) return;
        const place = this.place(event);
        this.touchStart = { x: event.clientX, y: event.clientY };
        this.send('touch', { ...place, down: true });
        this.longPress = setTimeout(() => {
            this.touchStart = null;
            this.send('touch', { ...place, down: false });
            this.send('down', { ...place, button: 3 });
            this.send('up', { ...place, button: 3 });
        }, kLongPressMs);
    }

    private onTouchMove(event: PointerEvent): void {
        if (!event.isPrimary || !this.touchStart) return;
        if (Math.hypot(event.clientX - this.touchStart.x, event.clientY - this.touchStart.y) > kTapSlop) clearTimeout(this.longPress);
        this.send('touch', { ...this.place(event), down: true });
    }

    private onTouchUp(event: PointerEvent): void {
        if (!event.isPrimary) return;
        clearTimeout(this.longPress);
        if (this.touchStart) this.send('touch', { ...this.place(event), down: false });
        this.touchStart = null;
    }

    private onKey(event: KeyboardEvent, isDown: boolean): void {
        if (leavesPicture(event)) {
            event.preventDefault();
            if (isDown) this.onLeave();
            return;
        }
        // The browser's own paste event follows, and carries the text.
        const isPaste = (event.ctrlKey || event.metaKey) && !event.altKey && event.key.toLowerCase() === 'v';
        if (isPaste || event.isComposing) return;
        event.preventDefault();
        // The program's X server repeats keys by itself.
        if (event.repeat) return;
        if (!isDown && !this.held.delete(event.code)) return;
        if (isDown) this.held.add(event.code);
        this.send('key', { key: event.key, code: event.code, down: isDown });
    }
}

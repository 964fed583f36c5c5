// The time from an input event to the first picture that shows its effect, as this browser measures it.

import { Cell } from './cell.ts';

const kMostPending = 256;
const kMostTimes = 50;

export class InputClock {
    // Median of the last events in ms; NaN: none.
    readonly medianMs = new Cell(NaN);
    private lastNumber = 0;
    private pending: { number: number; atMs: number }[] = [];
    private times: number[] = [];

    // Returns the number of a new event.
    next(): number {
        const number = ++this.lastNumber;
        this.pending.push({ number, atMs: performance.now() });
        if (this.pending.length > kMostPending) this.pending.shift();
        return number;
    }

    onShown(lastInput: number): void {
        if (!this.pending.length || this.pending[0]!.number > lastInput) return;
        const now = performance.now();
        for (; this.pending.length && this.pending[0]!.number <= lastInput; this.pending.shift())
            if (this.pending[0]!.number === lastInput) this.times.push(now - this.pending[0]!.atMs);
        if (this.times.length > kMostTimes) this.times.splice(0, this.times.length - kMostTimes);
        const sorted = [...this.times].sort((a, b) => a - b);
        this.medianMs.value = sorted[sorted.length >> 1] ?? NaN;
    }
}

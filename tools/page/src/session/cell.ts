// A value that views observe.

import { useEffect, useState } from 'preact/hooks';

export class Cell<Value> {
    private readonly listeners = new Set<() => void>();

    constructor(private current: Value) {}

    get value(): Value {
        return this.current;
    }

    set value(next: Value) {
        if (next === this.current) return;
        this.current = next;
        for (const listener of [...this.listeners]) listener();
    }

    listen(listener: () => void): () => void {
        this.listeners.add(listener);
        return () => this.listeners.delete(listener);
    }
}

// Returns the value of the cell, and renders the component again after each change.
export function useCell<Value>(cell: Cell<Value>): Value {
    const [, render] = useState({});
    useEffect(() => cell.listen(() => render({})), [cell]);
    return cell.value;
}

// Renders the component again each `ms` milliseconds.
export function useClock(ms: number): void {
    const [, render] = useState({});
    useEffect(() => {
        const timer = setInterval(() => render({}), ms);
        return () => clearInterval(timer);
    }, [ms]);
}

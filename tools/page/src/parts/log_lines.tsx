// Log lines with their levels in words.

import { useEffect, useRef } from 'preact/hooks';
import type { LogLine } from '../wire/types.ts';

// Returns the lines of a log document: JSON (an array, or an object with `lines`), or plain text.
export function parseLog(text: string): LogLine[] {
    try {
        const document = JSON.parse(text);
        const lines = Array.isArray(document) ? document : document.lines;
        if (Array.isArray(lines))
            return lines.map(line => (typeof line === 'string' ? { atSeconds: NaN, topic: '', level: '', text: line } : line));
    } catch {
        // Plain text.
    }
    return text.split('\n').filter(Boolean).map(line => ({ atSeconds: NaN, topic: '', level: '', text: line }));
}

export function LogLines({ lines, label }: { lines: LogLine[]; label: string }) {
    const list = useRef<HTMLDivElement>(null);
    const isAtEnd = useRef(true);
    useEffect(() => {
        if (isAtEnd.current && list.current) list.current.scrollTop = list.current.scrollHeight;
    }, [lines]);
    if (!lines.length) return <p class="empty">No lines yet.</p>;
    return (
        <div ref={list} class="log" role="log" aria-label={label} tabIndex={0} onScroll={event => {
            const { scrollTop, scrollHeight, clientHeight } = event.currentTarget;
            isAtEnd.current = scrollHeight - scrollTop - clientHeight < 20;
        }}>
            {lines.map((line, i) => (
                <p key={i} class={line.level}>
                    {Number.isFinite(line.atSeconds) && <time>{line.atSeconds.toFixed(1)}</time>}
                    {line.level && line.level !== 'info' && <b>{line.level}</b>} {line.text}
                </p>
            ))}
        </div>
    );
}

// Tabs over one panel. Arrow keys move between them.

import { useRef } from 'preact/hooks';
import type { ComponentChildren } from 'preact';

interface Props {
    label: string;
    tabs: [string, string][];
    value: string;
    onChange(value: string): void;
    children: ComponentChildren;
}

export function Tabs({ label, tabs, value, onChange, children }: Props) {
    const list = useRef<HTMLDivElement>(null);
    const key = (event: KeyboardEvent) => {
        const step = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
        if (!step) return;
        const at = (tabs.findIndex(([name]) => name === value) + step + tabs.length) % tabs.length;
        onChange(tabs[at]![0]);
        list.current?.querySelectorAll('button')[at]?.focus();
    };
    return (
        <>
            <div ref={list} class="tabs" role="tablist" aria-label={label} onKeyDown={key}>
                {tabs.map(([name, text]) => (
                    <button key={name} role="tab" aria-selected={name === value} tabIndex={name === value ? 0 : -1} onClick={() => onChange(name)}>{text}</button>
                ))}
            </div>
            <div role="tabpanel" aria-label={tabs.find(([name]) => name === value)?.[1]}>{children}</div>
        </>
    );
}
